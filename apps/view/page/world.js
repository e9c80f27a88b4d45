'use strict';

// A copy of the state of the server, kept up to date by its events. Metres, radians.

const TAIL = 400;       // scans drawn after the last node, at most: known space adds no nodes
const LATENCIES = 200;  // newest scans whose latency is shown
const FLASH = 1600;     // milliseconds that a closure lights up
const FLASHES = 12;     // closures that light up at the same time, at most
const REFUSED = 200;    // closures remembered, the newest

class World {
  constructor() {
    this.run = '';
    this.changes = 0;       // increases with every change
    this.graphChanges = 0;  // ... of nodes and closures
    this.clear();
  }

  clear() {
    this.resolution = 0.05;
    this.pose = null;     // the newest, as in the events
    this.nodes = [];      // [x, y, theta, xx, xy, yy, tt, linked]
    this.tail = [];       // positions of the newest scans since the last node
    this.tailJoined = true;  // no position since the last node was dropped
    this.closures = new Map();  // by id
    this.flashes = new Map();   // closure id -> time of its end
    this.counters = {scans: 0, unmatched: 0, nodes: 0, accepted: 0, pending: 0, refused: 0,
                     travelled: 0};
    this.latencies = [];
    this.clock = null;    // the log time and the real time when they were last compared
    this.speed = 0;       // log seconds a second
    this.ended = false;
    ++this.changes;
    ++this.graphChanges;
  }

  /** Replaces everything. True if it is another run of the program. */
  takeState(state) {
    const isOther = state.run !== this.run;
    this.clear();
    this.run = state.run;
    this.resolution = state.resolution;
    this.ended = state.ended;
    this.takeNodes(state);
    this.takeClosures(state.closures, false);
    this.counters = state.counters;
    if (state.pose) this.takePoses([state.pose]);
    return isOther;
  }

  takeNodes({first, nodes}) {
    this.nodes.length = Math.min(this.nodes.length, first);
    for (const node of nodes) this.nodes.push(node);
    ++this.changes;
    ++this.graphChanges;
  }

  takePoses(poses) {
    for (const pose of poses) {
      if (pose.node !== null) {
        this.tail = [];
        this.tailJoined = true;
      }
      this.tail.push([pose.x, pose.y]);
      this.latencies.push(pose.latency_ms);
    }
    if (this.tail.length > TAIL) {
      this.tail.splice(0, this.tail.length - TAIL);
      this.tailJoined = false;
    }
    if (this.latencies.length > LATENCIES) {
      this.latencies.splice(0, this.latencies.length - LATENCIES);
    }
    this.pose = poses[poses.length - 1];
    this.measureSpeed();
    ++this.changes;
  }

  // Log time that has passed in real time, over two seconds or so.
  measureSpeed() {
    const now = {real: performance.now() / 1000, log: this.pose.time};
    const passed = this.clock ? now.real - this.clock.real : Infinity;
    if (passed < 2) return;
    if (passed < 10) this.speed = Math.max(0, (now.log - this.clock.log) / passed);
    this.clock = now;
  }

  takeClosures(closures, flash) {
    for (const closure of closures) {
      const before = this.closures.get(closure.id);
      this.closures.set(closure.id, closure);
      if (flash && closure.outcome !== 'pending' && closure.outcome !== before?.outcome) {
        this.flash(closure.id);
      }
    }
    this.forgetRefused();
    ++this.changes;
    ++this.graphChanges;
  }

  forgetRefused() {
    const refused = [...this.closures.values()].filter((one) => verdict(one) === 'refused');
    for (const {id} of refused.slice(0, -REFUSED)) this.closures.delete(id);
  }

  flash(id) {
    this.flashes.delete(id);
    this.flashes.set(id, performance.now() + FLASH);
    if (this.flashes.size > FLASHES) this.flashes.delete(this.flashes.keys().next().value);
    ++this.changes;
  }

  /** Share of the flash that is left, 0..1. */
  flashOf(id, now) {
    const end = this.flashes.get(id);
    if (end === undefined) return 0;
    if (end <= now) this.flashes.delete(id);
    return Math.max(0, (end - now) / FLASH);
  }

  /** A copy that does not change. */
  frozen() {
    const copy = Object.assign(Object.create(World.prototype), this);
    copy.nodes = [...this.nodes];
    copy.tail = [...this.tail];
    copy.closures = new Map(this.closures);
    copy.flashes = new Map();
    copy.latencies = [...this.latencies];
    return copy;
  }
}

/** The kind of a closure's outcome: 'accepted', 'pending' or 'refused'. */
function verdict(closure) {
  return ['accepted', 'pending'].includes(closure.outcome) ? closure.outcome : 'refused';
}

// Follows /events. When the connection is lost, it tries again until close() is called.
class Link {
  /** `handlers`: `events`, a function for each event by name; `handled`, called after each event;
   *  `lost`, called whenever there is no connection. */
  constructor(handlers) {
    this.handlers = handlers;
    this.wait = 0;
    this.closed = false;
    this.open();
  }

  close() {
    this.closed = true;
    this.source.close();
  }

  open() {
    if (this.closed) return;
    const source = this.source = new EventSource('/events');
    for (const [name, handler] of Object.entries(this.handlers.events)) {
      source.addEventListener(name, (event) => {
        this.wait = 0;
        handler(JSON.parse(event.data));
        this.handlers.handled();
      });
    }
    source.onerror = () => {
      source.close();
      if (this.closed) return;
      this.handlers.lost();
      this.wait = Math.min(2000, this.wait + 250);
      setTimeout(() => this.open(), this.wait);
    };
  }
}

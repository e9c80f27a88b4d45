// The panels beside the map: state, figures, list of closures.

const STATES = {
  connecting: 'Connecting',
  live: 'Live',
  lost: 'Looking for itself in the map',
  reconnecting: 'Reconnecting',
  ended: 'Ended: the log is over, this is its last state',
};
const MARKS = {accepted: ['✓', 'closed'], refused: ['✕', 'refused'], pending: ['…', 'open']};
const LISTED = 60;            // closures, the newest
const PANEL_INTERVAL = 250;   // milliseconds between two changes of figures

const byId = (id) => document.getElementById(id);

function setText(id, text) {
  const element = byId(id);
  if (element.textContent !== text) element.textContent = text;
}

function metres(value) {
  if (value >= 1000) return `${(value / 1000).toFixed(2)} km`;
  return `${value.toFixed(value < 100 ? 1 : 0)} m`;
}

function milliseconds(value) {
  return Number.isFinite(value) ? `${value.toFixed(value < 10 ? 1 : 0)} ms` : '–';
}

class Panels {
  /** `show(closure)` is called when the user wants to see the closure on the map. */
  constructor(show) {
    this.show = show;
    this.drawn = {at: -Infinity, world: null, changes: -1};
    this.items = new Map();  // closure id -> its element
  }

  setState(state) {
    const element = byId('state');
    if (element.dataset.state === state) return;
    element.dataset.state = state;
    element.textContent = STATES[state];
    document.title = state === 'live' ? 'loopgrid' : `${STATES[state]} – loopgrid`;
  }

  /** Returns the milliseconds after which it has to be called again; 0 if it shows everything. */
  update(world, now) {
    const {drawn} = this;
    if (drawn.world === world && drawn.changes === world.changes) return 0;
    const early = drawn.at + PANEL_INTERVAL - now;
    if (early > 0 && drawn.world === world) return early;
    this.drawn = {at: now, world, changes: world.changes};
    this.updateFigures(world);
    this.updateClosures(world);
    return 0;
  }

  updateFigures(world) {
    const {counters} = world;
    const latencies = world.latencies.filter(Number.isFinite).sort((a, b) => a - b);
    setText('scans', counters.scans.toLocaleString('en'));
    setText('nodes', counters.nodes.toLocaleString('en'));
    setText('travelled', metres(counters.travelled));
    setText('speed', world.speed > 0.05 && !world.ended ? `${world.speed.toFixed(1)} ×` : '–');
    setText('latency', milliseconds(latencies[latencies.length >> 1]));
    setText('latency-max', milliseconds(latencies[latencies.length - 1]));
    setText('accepted', String(counters.accepted));
    setText('refused', String(counters.refused));
    setText('panel-summary', `${counters.nodes} nodes · loops: ${counters.accepted} closed, ` +
                             `${counters.refused} refused`);
  }

  updateClosures(world) {
    const newest = [...world.closures.keys()].sort((a, b) => b - a).slice(0, LISTED);
    const wanted = new Set(newest);
    for (const [id, item] of this.items) {
      if (wanted.has(id)) continue;
      item.remove();
      this.items.delete(id);
    }
    const list = byId('closures');
    let next = list.firstElementChild;
    for (const id of newest) {
      const item = this.itemOf(world.closures.get(id));
      if (item === next) next = next.nextElementSibling;
      else list.insertBefore(item, next);
    }
    byId('no-closures').hidden = newest.length > 0;
    list.hidden = newest.length === 0;
  }

  itemOf(closure) {
    const old = this.items.get(closure.id);
    if (old?.closure === closure) return old;
    const item = old ?? this.makeItem();
    const what = verdict(closure);
    const [mark, word] = MARKS[what];
    item.closure = closure;
    item.dataset.outcome = what;
    const parts = item.firstElementChild.children;
    parts[0].textContent = mark;
    parts[0].setAttribute('aria-label', word);
    parts[1].textContent = `${closure.to} → ${closure.from}`;
    parts[2].textContent = closure.score > 0
        ? `score ${closure.score.toFixed(2)} · ${metres(closure.distance)}` : '';
    parts[3].textContent = closure.reason;
    this.items.set(closure.id, item);
    return item;
  }

  makeItem() {
    const item = document.createElement('li');
    const button = document.createElement('button');
    button.type = 'button';
    button.title = 'Show on the map';
    for (const name of ['mark', 'nodes', 'fit', 'reason']) {
      const part = document.createElement('span');
      part.className = name;
      button.append(part);
    }
    button.firstElementChild.setAttribute('role', 'img');
    button.addEventListener('click', () => this.show(item.closure));
    item.append(button);
    return item;
  }
}

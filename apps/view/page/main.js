// Connects the parts and redraws the picture: at the rate of the display while something changes,
// and not at all otherwise.

const canvas = byId('view');
const world = new World();
const camera = new Camera();
const tiles = new Tiles(wakeAfter);
const scene = new Scene(canvas, camera, tiles);
let paused = null;        // the world as it was when the picture was paused
let needsDrawing = true;
let frameIsRequested = false;

// For tests, and for the console of the browser.
window.loopgrid = {
  fps: 0,                 // frames of the last second
  frames: 0,              // so far
  drawn: 0,               // frames that changed something
  firstPicture: null,     // milliseconds from the start of loading to the first piece of map
  get world() { return paused ?? world; },
  live: world,            // the latest state, also while the picture is paused
  get paused() { return Boolean(paused); },
  camera, tiles,
};

/** Asks for a frame. Call it after every change that may change the picture. */
function wake() {
  if (frameIsRequested) return;
  frameIsRequested = true;
  requestAnimationFrame(drawFrame);
}

function wakeAfter(milliseconds) {
  if (milliseconds > 0) setTimeout(wake, milliseconds);
  else wake();
}

function setPressed(id, pressed) {
  byId(id).setAttribute('aria-pressed', String(Boolean(pressed)));
}

function changed() {
  needsDrawing = true;
  wake();
  setPressed('fit', camera.mode === 'fit');
  setPressed('follow', camera.mode === 'follow');
}

function show(closure) {
  const shown = paused ?? world;
  const node = shown.nodes[closure.to];
  if (!node) return;
  camera.goTo(node[0], node[1]);
  shown.flash(closure.id);
  changed();
}

const panels = new Panels(show);

function savePicture() {
  canvas.toBlob((blob) => {
    const link = Object.assign(document.createElement('a'),
                               {href: URL.createObjectURL(blob), download: 'loopgrid.png'});
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  });
}

const actions = {
  changed,
  pan: (dx, dy) => { camera.pan(dx, dy); changed(); },
  zoom: (factor) => { camera.zoom(factor); changed(); },
  fit: () => { camera.mode = 'fit'; changed(); },
  follow: () => {
    camera.mode = camera.mode === 'follow' ? 'free' : 'follow';
    camera.goal = null;
    if (camera.mode === 'follow') camera.scale = Math.max(camera.scale, 24);
    changed();
  },
  pause: () => {
    paused = paused ? null : world.frozen();
    tiles.frozen = Boolean(paused);
    setPressed('pause', paused);
    byId('frozen').hidden = !paused;
    changed();
  },
  ellipses: () => {
    scene.showsEllipses = !scene.showsEllipses;
    setPressed('ellipses', scene.showsEllipses);
    changed();
  },
  save: savePicture,
  help: () => byId('help-dialog').showModal(),
  panel: () => {
    const isOpen = byId('panel').classList.toggle('open');
    byId('panel-toggle').setAttribute('aria-expanded', String(isOpen));
    layOut();
  },
};
new Controls(canvas, camera, actions);

// The part of the screen that panels leave free.
function layOut() {
  scene.resize();
  const [panel, tools, title] = ['panel', 'tools', 'title'].map(
      (id) => byId(id).getBoundingClientRect());
  const isNarrow = panel.left < 100;
  camera.insets = {left: 0, top: isNarrow ? title.bottom : 0,
                   right: isNarrow ? 0 : innerWidth - panel.left,
                   bottom: innerHeight - (isNarrow ? Math.min(panel.top, tools.top) : tools.top)};
  changed();
}
new ResizeObserver(layOut).observe(canvas);

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  scene.palette = readPalette();
  tiles.repaint();
  changed();
});

function showState() {
  panels.setState(world.ended ? 'ended' : world.pose?.localized === false ? 'lost' : 'live');
}

// The server has ended: send no more requests.
function leave() {
  tiles.offline = true;
  link.close();
}

const link = new Link({
  events: {
    state: (state) => {
      if (world.takeState(state)) tiles.reset(state.run, state.resolution);
      tiles.retry();
      tiles.take(state.tiles);
      showState();
    },
    nodes: (nodes) => world.takeNodes(nodes),
    poses: ({poses}) => { world.takePoses(poses); showState(); },
    closures: ({closures}) => world.takeClosures(closures, true),
    counters: (counters) => { world.counters = counters; },
    tiles: (event) => tiles.take(event.tiles),
    end: () => { world.ended = true; showState(); ++world.changes; },
  },
  handled: wake,
  lost: () => {
    if (world.ended) leave();
    else panels.setState('reconnecting');
  },
});

const seen = {world: null, changes: 0, tiles: 0};  // the state that the picture shows
const second = {start: performance.now(), frames: 0};
let last = performance.now();

function countFrame(now) {
  ++window.loopgrid.frames;
  if (now - last > 500) Object.assign(second, {start: now, frames: 0});  // nothing was drawn
  ++second.frames;
  if (now - second.start < 1000) return;
  window.loopgrid.fps = second.frames * 1000 / (now - second.start);
  Object.assign(second, {start: now, frames: 0});
}

function drawFrame(now) {
  frameIsRequested = false;
  countFrame(now);
  const seconds = Math.min(0.1, (now - last) / 1000);
  last = now;
  const shown = paused ?? world;
  const level = tiles.levelFor(camera.scale * scene.ratio);
  const robotMoves = scene.moveRobot(shown.pose, seconds);
  const cameraMoves = camera.step(seconds, scene.robot, tiles.bounds(level));
  if (robotMoves || cameraMoves) needsDrawing = true;
  if (seen.world !== shown || seen.changes !== shown.changes || seen.tiles !== tiles.changes) {
    Object.assign(seen, {world: shown, changes: shown.changes, tiles: tiles.changes});
    needsDrawing = true;
  }
  if (needsDrawing) {
    const more = scene.draw(shown, now);
    needsDrawing = more.motion;
    // Once the last tiles are here, the server is no longer needed.
    if (world.ended && !more.tiles) leave();
    ++window.loopgrid.drawn;
    if (window.loopgrid.firstPicture === null && [...tiles.tiles.values()].some((t) => t.picture)) {
      window.loopgrid.firstPicture = now;
    }
  }
  const panelsWait = panels.update(shown, now);
  if (panelsWait > 0) wakeAfter(panelsWait);
  if (robotMoves || cameraMoves || needsDrawing) wake();
}

layOut();

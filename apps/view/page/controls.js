// Mouse, touch, keys and buttons.

const KEY_STEP = 80;       // CSS pixels an arrow key moves the map
const KEY_ZOOM = 1.25;
const KEYS_SETTING = 'loopgrid.single-keys';

// The browser may not allow to store anything.
function remembered(name) {
  try { return localStorage.getItem(name); } catch { return null; }
}
function remember(name, value) {
  try { localStorage.setItem(name, value); } catch { /* it holds until the page is closed */ }
}

class Controls {
  /** `actions`: what buttons and keys do, by name. */
  constructor(canvas, camera, actions) {
    this.canvas = canvas;
    this.camera = camera;
    this.actions = actions;
    this.fingers = new Map();   // pointer id -> where it is
    this.listenToPointers();
    for (const name of ['fit', 'follow', 'pause', 'ellipses', 'save', 'help']) {
      byId(name).addEventListener('click', () => actions[name]());
    }
    byId('zoom-in').addEventListener('click', () => actions.zoom(KEY_ZOOM));
    byId('zoom-out').addEventListener('click', () => actions.zoom(1 / KEY_ZOOM));
    byId('panel-toggle').addEventListener('click', () => actions.panel());
    addEventListener('keydown', (event) => this.pressKey(event));
    this.singleKeys = byId('single-keys');
    this.singleKeys.checked = remembered(KEYS_SETTING) !== 'off';
    this.singleKeys.addEventListener(
        'change', () => remember(KEYS_SETTING, this.singleKeys.checked ? 'on' : 'off'));
  }

  listenToPointers() {
    const {canvas, camera, fingers} = this;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, [event.offsetX, event.offsetY]);
      canvas.classList.add('dragging');
    });
    canvas.addEventListener('pointermove', (event) => this.drag(event));
    for (const name of ['pointerup', 'pointercancel']) {
      canvas.addEventListener(name, (event) => {
        fingers.delete(event.pointerId);
        canvas.classList.toggle('dragging', fingers.size > 0);
      });
    }
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
      const turn = Math.max(-240, Math.min(240, event.deltaY * lines));
      camera.zoom(Math.exp(-turn * (event.ctrlKey ? 0.01 : 0.002)), [event.offsetX, event.offsetY]);
      this.actions.changed();
    }, {passive: false});
  }

  // One finger moves the map; two fingers also zoom it.
  drag(event) {
    const {fingers, camera} = this;
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const point = [event.offsetX, event.offsetY];
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    fingers.set(event.pointerId, point);
    const share = other ? 0.5 : 1;
    camera.pan((point[0] - before[0]) * share, (point[1] - before[1]) * share);
    if (other) {
      const length = (p) => Math.max(1, Math.hypot(p[0] - other[0], p[1] - other[1]));
      camera.zoom(length(point) / length(before), [(point[0] + other[0]) / 2,
                                                   (point[1] + other[1]) / 2]);
    }
    this.actions.changed();
  }

  pressKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || byId('help-dialog').open) return;
    const isCharacter = event.key.length === 1;   // other keys have names: 'ArrowLeft'
    if (isCharacter && !this.singleKeys.checked) return;
    const onControl = event.target.closest?.('button, a, #closures');
    if (onControl && [' ', 'Enter', 'ArrowUp', 'ArrowDown'].includes(event.key)) return;
    const {actions} = this;
    const keys = {
      ArrowLeft: () => actions.pan(KEY_STEP, 0),
      ArrowRight: () => actions.pan(-KEY_STEP, 0),
      ArrowUp: () => actions.pan(0, KEY_STEP),
      ArrowDown: () => actions.pan(0, -KEY_STEP),
      '+': () => actions.zoom(KEY_ZOOM),
      '=': () => actions.zoom(KEY_ZOOM),
      '-': () => actions.zoom(1 / KEY_ZOOM),
      '0': actions.fit,
      f: actions.follow,
      ' ': actions.pause,
      e: actions.ellipses,
      p: actions.save,
      '?': actions.help,
    };
    const action = keys[event.key] ?? keys[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  }
}

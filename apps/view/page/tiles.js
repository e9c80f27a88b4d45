// The map as squares at several scales. Fetches those that are on the screen and have changed. Each
// version of a tile is asked for once; if that fails, it is asked for again after retry().

const TILE_SIDE = 256;         // pixels
const TILE_LEVELS = 6;
const MAX_FETCHES = 4;         // at a time
const FETCH_INTERVAL = 300;    // milliseconds between two fetches of the same tile
const MAX_PICTURES = 256;      // kept: 256 KiB each
const GREY_WALL = 0;
const GREY_FREE = 254;

class Tiles {
  /** `wake(milliseconds)` asks to draw again after this time. */
  constructor(wake) {
    this.wake = wake;
    this.changes = 0;         // increases with every change
    this.frozen = false;      // what is on the screen stays as it is
    this.offline = false;     // nothing is fetched
    this.reset('', 0.05);
  }

  reset(run, resolution) {
    this.run = run;
    this.resolution = resolution;
    this.tiles = new Map();   // 'level/x/y' -> tile
    this.fetches = 0;
    ++this.changes;
  }

  /** Versions of tiles as in the events: [level, x, y, version]. */
  take(versions) {
    for (const [level, x, y, version] of versions) {
      const key = `${level}/${x}/${y}`;
      const tile = this.tiles.get(key);
      if (tile) tile.version = Math.max(tile.version, version);
      else this.tiles.set(key, {key, level, x, y, version, shown: 0, failed: 0, fetched: 0,
                                used: 0, fetching: false, picture: null, known: null});
    }
    ++this.changes;
  }

  /** Colours have changed: all pictures are made again. */
  repaint() {
    for (const tile of this.tiles.values()) tile.shown = tile.fetched = tile.failed = 0;
  }

  /** The server answers again: tiles that failed may be fetched again. */
  retry() {
    for (const tile of this.tiles.values()) tile.failed = 0;
  }

  side(level) {
    return TILE_SIDE * this.resolution * 2 ** level;
  }

  /** The level whose pixels are about as large as those of the screen, or smaller. */
  levelFor(pixelsPerMetre) {
    const cells = 1 / (pixelsPerMetre * this.resolution);
    return Math.min(TILE_LEVELS - 1, Math.max(0, Math.floor(Math.log2(cells) + 0.25)));
  }

  /** The known part of the map, as far as its tiles were loaded; null if nothing is known. */
  bounds(level) {
    let box = null;
    for (const tile of this.tiles.values()) {
      if (tile.level !== level) continue;
      const side = this.side(level);
      const [x0, y0, x1, y1] = tile.known ?? [0, 0, 1, 1];
      const part = {x0: (tile.x + x0) * side, y0: (tile.y + y0) * side,
                    x1: (tile.x + x1) * side, y1: (tile.y + y1) * side};
      box = box ? {x0: Math.min(box.x0, part.x0), y0: Math.min(box.y0, part.y0),
                   x1: Math.max(box.x1, part.x1), y1: Math.max(box.y1, part.y1)} : part;
    }
    return box;
  }

  /** Draws what `camera` sees and fetches missing tiles. True if some are not loaded yet. */
  draw(context, camera, ratio, palette, now) {
    const level = this.levelFor(camera.scale * ratio);
    const side = this.side(level);
    const view = camera.view();
    const [x0, y0] = [Math.floor(view.x0 / side), Math.floor(view.y0 / side)];
    const [x1, y1] = [Math.floor(view.x1 / side), Math.floor(view.y1 / side)];
    context.imageSmoothingEnabled = camera.scale * ratio * this.resolution < 1;
    let waiting = false;
    for (let y = y0; y <= y1; ++y) {
      for (let x = x0; x <= x1; ++x) {
        const tile = this.tiles.get(`${level}/${x}/${y}`);
        if (!tile) continue;
        tile.used = now;
        if (tile.shown < tile.version && !(this.frozen && tile.picture)) {
          if (this.fetch(tile, palette, now)) waiting = true;
        }
        this.drawTile(context, camera, ratio, tile);
      }
    }
    return waiting;
  }

  // While a tile is not loaded, a part of a coarser one is drawn, or finer ones.
  drawTile(context, camera, ratio, tile) {
    let [picture, sx, sy, size] = [tile.picture, 0, 0, TILE_SIDE];
    for (let up = 1; !picture && tile.level + up < TILE_LEVELS; ++up) {
      const [px, py] = [tile.x >> up, tile.y >> up];
      picture = this.tiles.get(`${tile.level + up}/${px}/${py}`)?.picture;
      size = TILE_SIDE >> up;
      sx = (tile.x - (px << up)) * size;
      sy = TILE_SIDE - size - (tile.y - (py << up)) * size;
    }
    if (!picture) {
      this.drawFiner(context, camera, ratio, tile);
      return;
    }
    const side = this.side(tile.level);
    const [left, top] = camera.toScreen(tile.x * side, (tile.y + 1) * side);
    const [right, bottom] = camera.toScreen((tile.x + 1) * side, tile.y * side);
    const [x, y] = [Math.round(left * ratio), Math.round(top * ratio)];
    context.drawImage(picture, sx, sy, size, size, x, y,
                      Math.round(right * ratio) - x, Math.round(bottom * ratio) - y);
  }

  drawFiner(context, camera, ratio, tile) {
    if (tile.level === 0) return;
    for (const [dx, dy] of [[0, 0], [1, 0], [0, 1], [1, 1]]) {
      const key = `${tile.level - 1}/${2 * tile.x + dx}/${2 * tile.y + dy}`;
      const part = this.tiles.get(key);
      if (part?.picture) this.drawTile(context, camera, ratio, part);
      else if (part) this.drawFiner(context, camera, ratio, part);
    }
  }

  // True if the tile is being fetched, or waits to be fetched.
  fetch(tile, palette, now) {
    if (this.offline || tile.failed >= tile.version) return false;
    if (tile.fetching || this.fetches >= MAX_FETCHES) return true;
    const early = tile.fetched + FETCH_INTERVAL - now;
    if (early > 0) this.wake(early);
    else this.load(tile, palette, now);
    return true;
  }

  async load(tile, palette, now) {
    const {run, tiles} = this;
    const version = tile.version;
    tile.fetching = true;
    tile.fetched = now;
    ++this.fetches;
    tile.failed = version;    // until it is loaded
    try {
      const reply = await fetch(`/tiles/${tile.key}.png?v=${run}.${version}`);
      if (!reply.ok) return;
      const image = await createImageBitmap(await reply.blob());
      if (tiles !== this.tiles) return;
      if (!tile.picture) this.makeRoom();
      this.paint(tile, image, palette);
      tile.shown = version;
      tile.failed = 0;
      ++this.changes;
    } catch {
      // The server is gone. When it is back, it sends its state, and then retry() is called.
    } finally {
      tile.fetching = false;
      if (tiles === this.tiles) --this.fetches;
      this.wake(0);           // another tile may be waiting
    }
  }

  // Turns grey into the colours of the page. Unknown pixels become transparent.
  paint(tile, image, palette) {
    tile.picture ??= Object.assign(document.createElement('canvas'),
                                   {width: TILE_SIDE, height: TILE_SIDE});
    const context = tile.picture.getContext('2d', {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    const data = context.getImageData(0, 0, TILE_SIDE, TILE_SIDE);
    const pixels = new Uint32Array(data.data.buffer);
    let [x0, y0, x1, y1] = [TILE_SIDE, TILE_SIDE, 0, 0];
    for (let y = 0, i = 0; y < TILE_SIDE; ++y) {
      for (let x = 0; x < TILE_SIDE; ++x, ++i) {
        const grey = pixels[i] & 255;
        const isKnown = grey === GREY_WALL || grey === GREY_FREE;
        pixels[i] = !isKnown ? 0 : grey === GREY_WALL ? palette.wall : palette.free;
        if (!isKnown) continue;
        if (x < x0) x0 = x;
        if (x >= x1) x1 = x + 1;
        if (y < y0) y0 = y;
        y1 = y + 1;
      }
    }
    context.putImageData(data, 0, 0);
    tile.known = [x0, TILE_SIDE - y1, x1, TILE_SIDE - y0].map((pixel) => pixel / TILE_SIDE);
  }

  makeRoom() {
    const kept = [...this.tiles.values()].filter((tile) => tile.picture);
    if (kept.length < MAX_PICTURES) return;
    const oldest = kept.reduce((a, b) => (a.used < b.used ? a : b));
    Object.assign(oldest, {picture: null, shown: 0});
  }
}

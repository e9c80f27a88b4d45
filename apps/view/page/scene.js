// Draws the world on the canvas.

// In two dimensions a point of a normal distribution is farther than r sigmas from the mean with
// the probability exp(-r^2 / 2).
const SIGMAS_OF_99 = Math.sqrt(-2 * Math.log(0.01));

/** The colours of the style sheet, for the canvas. */
function readPalette() {
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(`--${name}`).trim();
  const packed = (name) => {  // as stored in pixels: 0xAABBGGRR
    const rgb = parseInt(color(name).slice(1, 7), 16);
    return (0xff000000 | (rgb & 255) << 16 | rgb & 0xff00 | rgb >> 16) >>> 0;
  };
  return {unknown: color('unknown'), text: color('text'), quiet: color('quiet'),
          card: color('free'), path: color('path'), closed: color('closed'),
          refused: color('refused'), sigma: color('sigma'),
          wall: packed('wall'), free: packed('free')};
}

class Scene {
  constructor(canvas, camera, tiles) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d', {alpha: false});
    this.camera = camera;
    this.tiles = tiles;
    this.palette = readPalette();
    this.showsEllipses = false;
    this.robot = null;      // the pose where it is drawn; it moves smoothly to the newest pose
    this.paths = null;      // of the graph, and the state that they were made from
  }

  resize() {
    this.ratio = Math.min(2, devicePixelRatio || 1);
    const {clientWidth, clientHeight} = this.canvas;
    this.canvas.width = Math.round(clientWidth * this.ratio);
    this.canvas.height = Math.round(clientHeight * this.ratio);
    this.camera.width = clientWidth;
    this.camera.height = clientHeight;
  }

  /** Moves the robot towards its newest pose. True if it moved. */
  moveRobot(pose, seconds) {
    if (!pose) return Boolean(this.robot && !(this.robot = null));
    const before = this.robot;
    if (!before || this.camera.calm || Math.hypot(pose.x - before.x, pose.y - before.y) > 3) {
      this.robot = {x: pose.x, y: pose.y, theta: pose.theta};
    } else {
      const share = 1 - Math.exp(-seconds * 16);
      const turn = Math.atan2(Math.sin(pose.theta - before.theta),
                              Math.cos(pose.theta - before.theta));
      this.robot = {x: before.x + (pose.x - before.x) * share,
                    y: before.y + (pose.y - before.y) * share,
                    theta: before.theta + turn * share};
    }
    const {x, y, theta} = this.robot;
    return !before || Math.hypot(x - before.x, y - before.y) * this.camera.scale > 0.02 ||
        Math.abs(theta - before.theta) > 1e-3;
  }

  /** Returns why another frame is needed: `tiles` are being fetched, or there is `motion`. */
  draw(world, now) {
    const {context, canvas, palette} = this;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = palette.unknown;
    context.fillRect(0, 0, canvas.width, canvas.height);
    const waiting = this.tiles.draw(context, this.camera, this.ratio, palette, now);
    this.drawGraph(world);
    if (this.showsEllipses) this.drawEllipses(world);
    const flashing = this.drawFlashes(world, now);
    if (world.pose) this.drawRobot(world.pose);
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.drawScaleBar();
    return {tiles: waiting, motion: flashing};
  }

  // From here on coordinates on the canvas are metres.
  useMetres() {
    const [x, y] = this.camera.toScreen(0, 0);
    const scale = this.camera.scale * this.ratio;
    this.context.setTransform(scale, 0, 0, -scale, x * this.ratio, y * this.ratio);
  }

  pixels(count) {
    return count / this.camera.scale;
  }

  // Made once for each state of the graph; the canvas scales them.
  graphPaths(world) {
    const {paths} = this;
    if (paths?.world === world && paths.changes === world.graphChanges) return paths;
    const [path, closed] = [new Path2D(), new Path2D()];
    for (const [x, y, , , , , , linked] of world.nodes) {
      if (linked) path.lineTo(x, y);
      else path.moveTo(x, y);
    }
    for (const closure of world.closures.values()) {
      if (closure.outcome !== 'accepted') continue;
      const [from, to] = [world.nodes[closure.from], world.nodes[closure.to]];
      if (!from || !to) continue;
      closed.moveTo(from[0], from[1]);
      closed.lineTo(to[0], to[1]);
    }
    this.paths = {world, changes: world.graphChanges, path, closed};
    return this.paths;
  }

  drawGraph(world) {
    const {context, palette} = this;
    const {path, closed} = this.graphPaths(world);
    this.useMetres();
    context.lineJoin = context.lineCap = 'round';
    context.strokeStyle = palette.path;
    context.globalAlpha = 0.75;
    context.lineWidth = this.pixels(1.5);
    context.stroke(path);
    this.strokeTail(world);
    context.strokeStyle = palette.closed;
    context.lineWidth = this.pixels(1.8);
    context.globalAlpha = 0.8;
    context.stroke(closed);
    context.globalAlpha = 1;
    if (this.camera.scale > 14) this.drawNodes(world);
  }

  // From the last node to the robot.
  strokeTail(world) {
    const {context} = this;
    const last = world.nodes[world.nodes.length - 1];
    context.beginPath();
    if (last && world.tailJoined) context.moveTo(last[0], last[1]);
    for (const [x, y] of world.tail) context.lineTo(x, y);
    context.stroke();
  }

  drawNodes(world) {
    const {context, palette} = this;
    const view = this.camera.view();
    const radius = this.pixels(Math.min(3, this.camera.scale / 12));
    context.fillStyle = palette.path;
    context.beginPath();
    for (const [x, y] of world.nodes) {
      if (x < view.x0 || x > view.x1 || y < view.y0 || y > view.y1) continue;
      context.moveTo(x + radius, y);
      context.arc(x, y, radius, 0, 2 * Math.PI);
    }
    context.fill();
  }

  // Makes the path of the 99 % ellipse of a position, metres, from the covariance of x and y. False
  // if there is none, or if it is smaller than a pixel.
  ellipse(x, y, xx, xy, yy) {
    const mean = (xx + yy) / 2;
    const spread = Math.hypot((xx - yy) / 2, xy);
    const a = SIGMAS_OF_99 * Math.sqrt(mean + spread);
    const b = SIGMAS_OF_99 * Math.sqrt(Math.max(0, mean - spread));
    if (!(a > this.pixels(1))) return false;
    const angle = 0.5 * Math.atan2(2 * xy, xx - yy);
    this.context.moveTo(x + a * Math.cos(angle), y + a * Math.sin(angle));
    this.context.ellipse(x, y, a, b, angle, 0, 2 * Math.PI);
    return true;
  }

  // Leaves out ellipses that would overlap the last one that was drawn.
  drawEllipses(world) {
    const {context, palette} = this;
    const gap = this.pixels(22);
    let last = null;
    context.beginPath();
    for (const [x, y, , xx, xy, yy] of world.nodes) {
      if (last && Math.hypot(x - last[0], y - last[1]) < gap) continue;
      if (this.ellipse(x, y, xx, xy, yy)) last = [x, y];
    }
    context.strokeStyle = palette.sigma;
    context.lineWidth = this.pixels(1.2);
    context.globalAlpha = 0.85;
    context.stroke();
    context.globalAlpha = 1;
  }

  // Highlights the edge of a closure that has just been decided. If it was accepted, also draws a
  // ring that shrinks around the place that the robot has recognised.
  drawFlashes(world, now) {
    const {context, palette, camera} = this;
    for (const id of [...world.flashes.keys()]) {
      const closure = world.closures.get(id);
      const share = world.flashOf(id, now);
      const [from, to] = [world.nodes[closure?.from], world.nodes[closure?.to]];
      if (!share || !from || !to) continue;
      const isClosed = verdict(closure) === 'accepted';
      context.strokeStyle = isClosed ? palette.closed : palette.refused;
      context.globalAlpha = camera.calm ? 0.9 : Math.min(1, 1.6 * share);
      context.lineWidth = this.pixels(isClosed ? 3.5 : 2);
      context.setLineDash(isClosed ? [] : [this.pixels(5), this.pixels(6)]);
      context.beginPath();
      context.moveTo(from[0], from[1]);
      context.lineTo(to[0], to[1]);
      context.stroke();
      context.setLineDash([]);
      if (!isClosed) continue;
      context.lineWidth = this.pixels(1.8);
      context.beginPath();
      context.arc(from[0], from[1], this.pixels(camera.calm ? 8 : 6 + 12 * share * share), 0,
                  2 * Math.PI);
      context.stroke();
    }
    context.globalAlpha = 1;
    return world.flashes.size > 0;
  }

  drawRobot(pose) {
    const {context, palette, robot} = this;
    const [xx, xy, yy] = pose.covariance;
    context.beginPath();
    if (this.ellipse(robot.x, robot.y, xx, xy, yy)) {
      context.strokeStyle = context.fillStyle = palette.sigma;
      context.globalAlpha = 0.14;
      context.fill();
      context.globalAlpha = 1;
      context.lineWidth = this.pixels(1.5);
      context.stroke();
    }
    context.save();
    context.translate(robot.x, robot.y);
    context.rotate(robot.theta);
    const unit = this.pixels(1);
    context.beginPath();
    context.moveTo(13 * unit, 0);
    context.lineTo(-8 * unit, 8 * unit);
    context.lineTo(-4.5 * unit, 0);
    context.lineTo(-8 * unit, -8 * unit);
    context.closePath();
    context.lineWidth = 3 * unit;
    context.strokeStyle = palette.card;
    context.stroke();
    context.fillStyle = pose.localized ? palette.path : palette.sigma;
    context.fill();
    context.restore();
  }

  drawScaleBar() {
    const {context, palette, camera} = this;
    const wished = 110 / camera.scale;
    const power = 10 ** Math.floor(Math.log10(wished));
    const metres = power * [5, 2, 1].find((step) => step * power <= wished);
    const [x, y] = [camera.insets.left + 20, camera.height - camera.insets.bottom - 14];
    const width = metres * camera.scale;
    context.strokeStyle = palette.text;
    context.fillStyle = palette.text;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, y - 5);
    context.lineTo(x, y);
    context.lineTo(x + width, y);
    context.lineTo(x + width, y - 5);
    context.stroke();
    context.font = '12px system-ui, "DejaVu Sans", sans-serif';
    context.fillText(metres < 1 ? `${Math.round(metres * 100)} cm` : `${metres} m`, x + 4, y - 6);
  }
}

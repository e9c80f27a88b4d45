// Which part of the map is on the screen: converts metres to CSS pixels. x to the right, y upwards.

const MIN_SCALE = 0.5;   // CSS pixels a metre
const MAX_SCALE = 400;

class Camera {
  constructor() {
    this.x = 0;          // metres, in the middle of the free part of the screen
    this.y = 0;
    this.scale = 20;     // CSS pixels a metre
    this.width = 1;      // CSS pixels
    this.height = 1;
    this.insets = {left: 0, top: 0, right: 0, bottom: 0};  // covered by panels
    this.mode = 'fit';   // 'fit': all of the map, 'follow': the robot, 'free'
    this.goal = null;    // {x, y, scale} that it moves to smoothly
    this.calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
  }

  get middle() {
    const {left, top, right, bottom} = this.insets;
    return [(left + this.width - right) / 2, (top + this.height - bottom) / 2];
  }

  toScreen(x, y) {
    const [cx, cy] = this.middle;
    return [cx + (x - this.x) * this.scale, cy - (y - this.y) * this.scale];
  }

  toMap(px, py) {
    const [cx, cy] = this.middle;
    return [this.x + (px - cx) / this.scale, this.y - (py - cy) / this.scale];
  }

  /** The part of the map that is on the screen. */
  view() {
    const [x0, y0] = this.toMap(0, this.height);
    const [x1, y1] = this.toMap(this.width, 0);
    return {x0, y0, x1, y1};
  }

  pan(dx, dy) {
    this.mode = 'free';
    this.goal = null;
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  /** Zooms around a point of the screen, or around the middle; the robot is still followed. */
  zoom(factor, point = null) {
    const scale = Math.min(MAX_SCALE, Math.max(MIN_SCALE, this.scale * factor));
    if (this.mode === 'fit' || (point && this.mode !== 'follow')) this.mode = 'free';
    this.goal = null;
    if (point && this.mode === 'free') {
      const [x, y] = this.toMap(...point);
      this.scale = scale;
      const [nx, ny] = this.toMap(...point);
      this.x += x - nx;
      this.y += y - ny;
    }
    this.scale = scale;
  }

  goTo(x, y) {
    this.mode = 'free';
    this.goal = {x, y, scale: Math.max(this.scale, 30)};
  }

  fitGoal(box) {
    const {left, top, right, bottom} = this.insets;
    const free = [this.width - left - right - 32, this.height - top - bottom - 32];
    const scale = Math.min(free[0] / Math.max(4, box.x1 - box.x0),
                           free[1] / Math.max(4, box.y1 - box.y0));
    return {x: (box.x0 + box.x1) / 2, y: (box.y0 + box.y1) / 2,
            scale: Math.min(60, Math.max(MIN_SCALE, scale))};
  }

  /** Continues its motion by `seconds`. True if it moved. */
  step(seconds, robot, box) {
    if (this.mode === 'fit' && box) this.goal = this.fitGoal(box);
    if (this.mode === 'follow' && robot) this.goal = {x: robot.x, y: robot.y, scale: this.scale};
    if (!this.goal) return false;
    const share = this.calm ? 1 : 1 - Math.exp(-seconds * 9);
    const before = [this.x, this.y, this.scale];
    this.x += (this.goal.x - this.x) * share;
    this.y += (this.goal.y - this.y) * share;
    this.scale *= (this.goal.scale / this.scale) ** share;
    const left = Math.hypot(this.goal.x - this.x, this.goal.y - this.y) * this.scale;
    if (left < 0.1 && Math.abs(this.goal.scale / this.scale - 1) < 1e-3) {
      Object.assign(this, this.goal);
      this.goal = null;
    }
    return before[0] !== this.x || before[1] !== this.y || before[2] !== this.scale;
  }
}

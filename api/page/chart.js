// A strip chart on a canvas: series of (time, low, high) in rings, drawn once per frame when something changed.

const CAPACITY = 1 << 15;

export class Ring {
  constructor() {
    this.t = new Float64Array(CAPACITY); this.low = new Float64Array(CAPACITY); this.high = new Float64Array(CAPACITY);
    this.clear();
  }

  clear() { this.count = 0; }

  push(t, lows, highs) {
    for (let i = 0; i < t.length; i++) {
      const at = this.count++ % CAPACITY;
      this.t[at] = t[i];
      this.low[at] = lows[i] === null ? NaN : lows[i];
      this.high[at] = highs[i] === null ? NaN : highs[i];
    }
  }

  get first() { return Math.max(0, this.count - CAPACITY); }
  get last() { return this.count ? this.t[(this.count - 1) % CAPACITY] : NaN; }
  get start() { return this.count ? this.t[this.first % CAPACITY] : NaN; }

  // The first index whose time is at or after t (times rise).
  from(t) {
    let low = this.first, high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t[middle % CAPACITY] < t) low = middle + 1; else high = middle;
    }
    return low;
  }
}

export class Strip {
  // series: [{name, colour (a CSS variable), dash}], scale: factor to the shown unit, least: smallest shown range.
  constructor(canvas, { series, scale, least }) {
    Object.assign(this, { canvas, series, scale, least, seconds: 5, range: null, cursor: null });
    this.rings = Object.fromEntries(series.map(({ name }) => [name, new Ring()]));
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  clear() { Object.values(this.rings).forEach((ring) => ring.clear()); this.range = null; }

  push(block) {
    for (const { name } of this.series) {
      const t = name.endsWith("_sim") ? block.t_sim : block.t;
      if (block[name] && t) this.rings[name].push(t, ...block[name]);
    }
  }

  window() {
    const ring = this.rings[this.series[0].name];
    const end = ring.count ? ring.last : this.seconds || 5;
    const start = this.seconds ? end - this.seconds : Math.min(ring.count ? ring.start : 0, end - 1);
    return [start, end];
  }

  limits(start) {
    let low = Infinity, high = -Infinity;
    for (const ring of Object.values(this.rings)) {
      for (let i = ring.from(start); i < ring.count; i++) {
        const at = i % CAPACITY;
        if (ring.low[at] < low) low = ring.low[at];
        if (ring.high[at] > high) high = ring.high[at];
      }
    }
    if (low > high) [low, high] = [-this.least / 2, this.least / 2];
    const room = Math.max(this.least - (high - low), 0.12 * (high - low)) / 2;
    return this.settle(low - room, high + room);
  }

  // Grow at once, shrink only when much is empty: an axis that breathes can't be read.
  settle(low, high) {
    const [oldLow, oldHigh] = this.range || [low, high];
    const roomy = high - low < 0.6 * (oldHigh - oldLow);
    this.range = roomy ? [low, high] : [Math.min(low, oldLow), Math.max(high, oldHigh)];
    return this.range;
  }

  draw() {
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width) return;
    if (this.canvas.width !== Math.round(width * ratio) || this.canvas.height !== Math.round(height * ratio)) {
      this.canvas.width = Math.round(width * ratio); this.canvas.height = Math.round(height * ratio);
    }
    const pen = this.canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const style = getComputedStyle(this.canvas);
    const box = { left: 46, right: width - 6, top: 6, bottom: height - 18 };
    const [start, end] = this.window(), [low, high] = this.limits(start);
    const X = (t) => box.left + ((t - start) / (end - start)) * (box.right - box.left);
    const Y = (v) => box.bottom - ((v - low) / (high - low)) * (box.bottom - box.top);
    this.grid(pen, style, box, X, Y, start, end, low, high);
    pen.save();
    pen.beginPath(); pen.rect(box.left, 0, box.right - box.left, height); pen.clip();
    for (const series of this.series) this.line(pen, style, series, X, Y, start);
    pen.restore();
  }

  grid(pen, style, box, X, Y, start, end, low, high) {
    pen.font = "11px system-ui, sans-serif"; pen.lineWidth = 1;
    pen.strokeStyle = style.getPropertyValue("--grid"); pen.fillStyle = style.getPropertyValue("--muted");
    pen.textAlign = "right"; pen.textBaseline = "middle";
    for (const tick of ticks(low * this.scale, high * this.scale, (box.bottom - box.top) / 34)) {
      const y = Math.round(Y(tick.value / this.scale)) + 0.5;
      stroke(pen, box.left, y, box.right, y);
      pen.fillText(tick.text, box.left - 6, y);
    }
    pen.textAlign = "center"; pen.textBaseline = "top";
    for (const tick of ticks(start, end, (box.right - box.left) / 80)) {
      const x = Math.round(X(tick.value)) + 0.5;
      stroke(pen, x, box.top, x, box.bottom);
      if (x < box.right - 56) pen.fillText(tick.text, x, box.bottom + 4);
    }
    pen.textAlign = "right"; pen.fillText("time, s", box.right, box.bottom + 4);
  }

  line(pen, style, { name, colour, dash = [], weight = 1.6 }, X, Y, start) {
    const ring = this.rings[name];
    pen.strokeStyle = style.getPropertyValue(colour); pen.lineWidth = weight; pen.lineJoin = "round"; pen.setLineDash(dash);
    pen.beginPath();
    let down = false, rising = true;
    for (let i = Math.max(ring.from(start) - 1, ring.first); i < ring.count; i++) {
      const at = i % CAPACITY;
      if (Number.isNaN(ring.low[at])) { down = false; continue; }
      const x = X(ring.t[at]);
      const pair = rising ? [ring.low[at], ring.high[at]] : [ring.high[at], ring.low[at]];
      if (down) pen.lineTo(x, Y(pair[0])); else pen.moveTo(x, Y(pair[0]));
      if (pair[1] !== pair[0]) pen.lineTo(x, Y(pair[1]));
      down = true; rising = i + 1 < ring.count ? ring.high[(i + 1) % CAPACITY] >= ring.high[at] : rising;
    }
    pen.stroke(); pen.setLineDash([]);
  }
}

function stroke(pen, x0, y0, x1, y1) { pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(x1, y1); pen.stroke(); }

// About `wanted` round values between low and high.
export function ticks(low, high, wanted) {
  const rough = (high - low) / Math.max(wanted, 1), power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough) || 10 * power;
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), found = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) found.push({ value: k * step, text: (k * step + 0).toFixed(digits) });
  return found;
}

// A small picture of one planned motion.
export function sparkline(canvas, t, y) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth || 260, height = canvas.clientHeight || 44;
  canvas.width = width * ratio; canvas.height = height * ratio;
  const pen = canvas.getContext("2d"), high = Math.max(...y, 1e-9), low = Math.min(...y, 0);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.strokeStyle = getComputedStyle(canvas).getPropertyValue("--measured"); pen.lineWidth = 1.5; pen.beginPath();
  t.forEach((time, i) => pen.lineTo(((time - t[0]) / (t.at(-1) - t[0])) * (width - 2) + 1, height - 3 - ((y[i] - low) / (high - low)) * (height - 6)));
  pen.stroke();
}

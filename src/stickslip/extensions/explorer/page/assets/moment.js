// What all panels show at the time of the cursor. Nothing here asks the server: sources are changed in the browser alone.

/** The index of the last entry that is not later than t: the limit from the right at a shock. */
function lastUpTo(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

/** The value of a column at time t, on straight lines between its points. */
function valueAt(times, values, t) {
  if (!times.length) return NaN;
  const i = lastUpTo(times, t), j = Math.min(i + 1, times.length - 1);
  if (t <= times[0] || times[j] === times[i]) return values[i];
  const share = Math.min((t - times[i]) / (times[j] - times[i]), 1);
  return values[i] + share * (values[j] - values[i]);
}

/** The models of a Bokeh document by name, changed without telling the server. */
class Models {
  constructor(bokeh) { this.bokeh = bokeh; this.found = new Map(); }

  get(name) {
    if (!this.found.has(name)) this.found.set(name, this.bokeh.get_model_by_name(name));
    return this.found.get(name);
  }

  column(source, name) { return this.get(`source:${source}`)?.get_column(name) ?? []; }

  put(source, data) { this.get(`source:${source}`)?.setv({ data }, { sync: false }); }

  set(name, changes) { this.get(name)?.setv(changes, { sync: false }); }

  /** The names of all axes of the panels, which a view can hide. */
  get axes() {
    this.named ??= [...(this.bokeh.all_models ?? this.bokeh._all_models?.values() ?? [])].map(({ name }) => name).filter((name) => name?.startsWith("axis:") && !name.includes("@strip_"));
    return this.named;
  }
}

const TIME_PLOTS = ["slip", "rate", "state", "residual", "given", "also_given", "traction"], NEAR_PLOTS = ["field", "energy"];
const COLUMNS_DRAWN = 11, ROWS_DRAWN = 20;

/** Time t on the axis of the panels of slab and energy, which show one event of a long run; and back. */
function nearOf(facts, t) { return facts.near ? (t * facts.time.size - facts.near.begin) / facts.near.size : t; }
function fromNear(facts, x) { return facts.near ? (facts.near.begin + x * facts.near.size) / facts.time.size : x; }

/** Bring the cursor of all panels to time t (in the unit shown); return the values there. */
function showMoment(models, facts, t) {
  const near = nearOf(facts, t);
  for (const name of TIME_PLOTS) models.set(`cursor:${name}`, { location: t });
  for (const name of NEAR_PLOTS) models.set(`cursor:${name}`, { location: near });
  const times = models.column("motion", "time"), values = {};
  for (const name of ["slip", "rate", "rate_at", "traction", "load", "drive"]) {
    const column = models.column("motion", name);
    if (column.length) values[name] = valueAt(times, column, t);
  }
  models.put("now", { time: [t], slip: [values.slip], rate_at: [values.rate_at], traction: [values.traction] });
  showLaw(models, t);
  showContact(models, facts, t);
  if (facts.shape?.kind === "slab") showSlab(models, facts, near);
  else if (facts.shape) showBlock(models, facts, values);
  if (facts.profile) showProfile(models, near);
  return values;
}

/** The friction coefficient that acts at time t; at rest it is what the load needs, and lies below the law's curve. */
function showLaw(models, t) {
  const times = models.column("motion", "time");
  const [x, y] = ["law_x", "law_y"].map((name) => valueAt(times, models.column("motion", name), t));
  models.put("now_law", { x: [x], y: [y] });
}

function showContact(models, facts, t) {
  if (!facts.contact) return;
  const times = models.column("path", "time");
  const rate = valueAt(times, models.column("path", "rate"), t), load = valueAt(times, models.column("path", "load"), t);
  models.put("now_contact", { rate: [rate], load: [load] });
  if (Number.isFinite(load)) models.set("cursor:contact", { location: load });
}

/** The images over time and place as functions of a row at time t; nothing before the first answer. */
function imagesAt(models, t) {
  const [displacement, velocity] = ["displacement", "velocity"].map((name) => models.column("field", name)[0]);
  if (!displacement) return null;
  const [rows, columns] = displacement.shape;
  const start = models.column("field", "x")[0], span = models.column("field", "dw")[0];
  const at = Math.min(Math.max((t - start) / span * columns - 0.5, 0), columns - 1);
  const left = Math.floor(at), right = Math.min(left + 1, columns - 1), share = at - left;
  const mean = (values) => (row) => values[row * columns + left] * (1 - share) + values[row * columns + right] * share;
  return { rows, displacement: mean(displacement), velocity: mean(velocity) };
}

/** Slip rate and slip of a fault at time t, from place to place. */
function showProfile(models, t) {
  const found = imagesAt(models, t), y = models.column("profile", "y");
  if (!found) return;
  const along = (value) => Float64Array.from(y, (_, row) => value(row));
  models.put("profile", { y, rate: along(found.velocity), slip: along(found.displacement) });
}

/** The slab, sheared by the displacements at time t: lines that were straight across it, and particles coloured by velocity. */
function showSlab(models, facts, t) {
  const { scale, bar, width, height, low, boundaries, text } = facts.shape;
  const found = imagesAt(models, t);
  if (!found) return;
  const { rows, displacement, velocity } = found;
  const u = [], y = [], size = height - low;
  for (let row = 0; row < rows; row++) { u.push(scale * displacement(row)); y.push(low + row / (rows - 1) * size); }
  const first = 0.06 * width, step = 0.58 * width / (COLUMNS_DRAWN - 1);
  const lines = { x: [], y: [] }, particles = { x: [], y: [], velocity: [] };
  for (let column = 0; column < COLUMNS_DRAWN; column++) {
    const x = first + column * step;
    lines.x.push(u.map((one) => x + one));
    lines.y.push(y);
    for (let one = 0; one < ROWS_DRAWN; one++) {
      const row = Math.round((one + 0.5) / ROWS_DRAWN * rows - 0.5);
      particles.x.push(x + u[row]);
      particles.y.push(y[row]);
      particles.velocity.push(velocity(row));
    }
  }
  const end = first + (COLUMNS_DRAWN - 1) * step, top = u[rows - 1], twoSided = low < 0;
  for (const place of boundaries) {
    const moved = twoSided && place === 0 ? 0 : u[Math.round((place - low) / size * (rows - 1))];
    lines.x.push([first + moved, end + moved]);
    lines.y.push([place, place]);
  }
  models.put("lines", lines);
  models.put("particles", particles);
  models.put("body", { x: [], y: [] });
  models.put("driver", { x: [[first + top - 0.3, end + top + 0.3], scaleBar(width, bar)], y: [[height, height], [height + 0.08 * size, height + 0.08 * size]] });
  models.put("texts", { x: [first + top + 1.5, 0.97 * width - bar], y: [height + 0.04 * size, height + 0.05 * size], text: ["driver", text] });
  const other = low - 0.02 * size;  // the ground, or the driver of the other side
  models.put("ground", { x0: [0], x1: [width], y0: [low - (twoSided ? 0.06 : 0.16) * size], y1: [other] });
}

/** The block at time t, on the ground, and its spring up to the end that is pulled. */
function showBlock(models, facts, values) {
  const { scale, bar, width, height, text } = facts.shape;
  const origin = models.column("motion", "slip")[0], drive = models.column("motion", "drive")[0];
  const u = scale * (values.slip - origin), pulled = scale * ((values.drive ?? drive) - drive);
  const [left, right, low, high] = [0.06 * width + u, 0.3 * width + u, 0.02 * height, 0.42 * height];
  models.put("body", { x: [[left, right, right, left]], y: [[low, low, high, high]] });
  const end = 0.92 * width + pulled, middle = (low + high) / 2, teeth = 9;
  const spring = { x: [right, right + 0.3], y: [middle, middle] };
  for (let one = 0; one <= teeth; one++) {
    spring.x.push(right + 0.3 + (end - right - 0.6) * (one + 0.5) / (teeth + 1));
    spring.y.push(middle + (one % 2 ? -1 : 1) * 0.07 * height);
  }
  spring.x.push(end - 0.3, end);
  spring.y.push(middle, middle);
  models.put("lines", { x: [spring.x], y: [spring.y] });
  models.put("particles", { x: [], y: [], velocity: [] });
  models.put("driver", { x: [[end, end], scaleBar(width, bar)], y: [[low, 0.5 * height], [1.08 * height, 1.08 * height]] });
  models.put("texts", { x: [end + 0.4, 0.97 * width - bar, (left + right) / 2 + 0.5], y: [0.54 * height, 1.05 * height, middle - 0.03 * height], text: ["driver", text, "block"] });
  models.put("ground", { x0: [0], x1: [width], y0: [-0.16 * height], y1: [0] });
}

function scaleBar(width, bar) { return [0.98 * width - bar, 0.98 * width]; }

/** Digits after the point with which a time of a span can be told apart from its neighbours. */
function digitsFor(span) { return Math.min(Math.max(3 - Math.floor(Math.log10(span || 1)), 0), 6); }

/** A number in at most four digits, with a true minus. */
function shortNumber(value) {
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : value.toFixed(size >= 100 ? 1 : size >= 10 ? 2 : 3);
  return text.replace("-", "−");
}

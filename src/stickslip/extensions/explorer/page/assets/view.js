// What an answer shows is brought to the models of Bokeh here, in the browser: nothing of it is kept by the server.

/** A view from the block of bytes that `view_bytes` makes in Python; its columns are arrays that lie in the block itself. */
function readView(block) {
  const size = Number(new DataView(block).getBigUint64(0, true)), begin = 8 + size;
  const view = JSON.parse(new TextDecoder().decode(new Uint8Array(block, 8, size)));
  const column = (found) => {
    if (Array.isArray(found)) return found.map(column);
    const { at, length, shape } = found;
    return shape ? imageOf(new Float32Array(block, begin + at, shape[0] * shape[1]), shape) : new Float64Array(block, begin + at, length);
  };
  for (const columns of Object.values(view.columns)) for (const name of Object.keys(columns)) columns[name] = column(columns[name]);
  return view;
}

/** Numbers as Bokeh keeps an image. */
function imageOf(numbers, shape) {
  return Bokeh.require("core/util/ndarray").ndarray(numbers, { dtype: "float32", shape });
}

/** True if two columns hold the same numbers; NaN is the same as NaN. */
function isSame(one, other) {
  if (one?.length !== other?.length || String(one?.shape) !== String(other?.shape)) return false;
  for (let i = 0; i < one.length; i++) {
    const [a, b] = [one[i], other[i]];
    if (!(typeof a === "object" && a ? isSame(a, b) : Object.is(a, b) || a === b)) return false;
  }
  return true;
}

/** Bring columns, limits and texts of axes to the models; a source that would not change is left alone, and draws nothing. */
function showColumns(models, { columns, limits, labels }) {
  for (const [source, found] of Object.entries(columns)) {
    if (!Object.entries(found).every(([name, column]) => isSame(column, models.column(source, name)))) models.put(source, found);
  }
  for (const [name, [start, end]] of Object.entries(limits)) models.set(`range:${name}`, { start, end, reset_start: start, reset_end: end });
  for (const [name, text] of Object.entries(labels)) models.set(name, { axis_label: text });
}

/** Bring the whole view of an answer to the models, and its headings to their places. */
function showView(models, view) {
  showColumns(models, view);
  models.set("colour", { low: -view.fastest, high: view.fastest });
  for (const name of models.axes) models.set(name, { visible: !view.hidden.includes(name) });
  for (const [name, html] of Object.entries(view.headings)) {
    const place = document.querySelector(`[data-heading=${name}]`); // a notebook's cell has headings of its own
    if (place && place.told !== html) { place.innerHTML = html; place.told = html; }
  }
}

/**
 * Spare the browser work that has no use here. For each colour and size that Bokeh paints, and for the size of type, it asks the style
 * sheets, in which nothing is said of them; and it writes the places of invisible elements anew where they have not moved. Together
 * these have all styles of the page worked out some forty times for each answer.
 */
function spareStyles() {
  try {
    Bokeh.require("core/visuals/visual").VisualProperties.prototype._get_css_value = () => "";
    Object.defineProperty(Bokeh.require("models/plots/plot_canvas").PlotView.prototype, "base_font_size", { get: () => 13, configurable: true });
    const sheet = Bokeh.require("core/dom").InlineStyleSheet.prototype, write = sheet._update;
    if (!sheet.spared) sheet._update = function (css) { if (this.el.textContent !== css) write.call(this, css); };
    sheet.spared = true;
  } catch { /* another version of Bokeh, which draws the same more slowly */ }
}

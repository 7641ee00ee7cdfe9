// The controls: a slider, a number field and a unit for each number, and a list for each choice. Native elements, for keyboard and readers.

/** The number at a slider's position (0 to 1000), rounded to digits that a reader wants to see. */
function numberAt(row, position) {
  const share = position / 1000;
  const value = row.log ? row.low * (row.high / row.low) ** share : row.low + share * (row.high - row.low);
  return row.whole ? Math.round(value) : Number(value.toPrecision(4));
}

/** The slider's position of a number; outside its range the slider is at its end. */
function positionOf(row, value) {
  const share = row.log ? Math.log(value / row.low) / Math.log(row.high / row.low) : (value - row.low) / (row.high - row.low);
  return Number.isFinite(share) ? 1000 * Math.min(Math.max(share, 0), 1) : 0;
}

const LONGEST_WAIT = 400; // ms; after it the next value is sent although nothing came back

class Controls {
  constructor(root, send) {
    this.root = root; this.send = send; this.rows = new Map(); this.drawn = "";
    root.className = "controls";
  }

  /** Show groups of rows: they are made anew only if other rows are needed, so that the focus stays where it is. */
  update(groups, values) {
    const paths = groups.flatMap(({ rows }) => rows.map(({ path }) => path));
    if (paths.length !== Object.keys(values).length || !paths.every((path) => path in values)) return; // one of the two is still to come
    this.heard();
    const form = JSON.stringify([groups, Object.values(values).map(({ range }) => !range)]);
    if (form !== this.drawn) this.make(groups.map(({ title, rows }) => ({ title, rows: rows.map((row) => ({ ...row, ...values[row.path] })) })));
    this.drawn = form;
    for (const [path, held] of Object.entries(values)) this.fill(path, held);
  }

  /** Say what is wrong beside the rows that are; what was entered there stays. */
  blame(faults) {
    for (const [path, { field, fault, line }] of this.rows) {
      const text = faults[path] ?? "";
      field.setAttribute("aria-invalid", String(Boolean(text)));
      if (fault.textContent === text) continue;
      fault.textContent = text;
      if (text) line.scrollIntoView({ block: "nearest" });
    }
  }

  /** Send what was entered in a field or chosen; a value of a slider that still waits is older. */
  enter(message) {
    this.waiting = null;
    this.send(message);
  }

  make(groups) {
    this.waiting = null; // it was meant for other rows
    const open = this.wasOpen = new Map([...this.root.querySelectorAll("details")].map((one) => [one.dataset.title, one.open]));
    const focused = this.root.getRootNode().activeElement?.id;
    this.rows.clear();
    this.root.replaceChildren(...groups.map((group) => this.makeGroup(group, open.get(group.title) ?? group.open ?? true)));
    if (focused) this.root.querySelector(`#${CSS.escape(focused)}`)?.focus();
  }

  makeGroup({ title, rows }, open) {
    const group = document.createElement("details");
    group.open = open; group.dataset.title = title;
    const heading = document.createElement("summary");
    heading.textContent = title;
    group.append(heading, ...rows.filter((row) => !row.rare).map((row) => this.makeRow(row)));
    const rare = rows.filter((row) => row.rare);
    if (rare.length && !title.startsWith("More")) group.append(this.makeGroup({ title: `More of ${title.toLowerCase()}`, rows: rare.map((row) => ({ ...row, rare: false })) }, this.wasOpen?.get(`More of ${title.toLowerCase()}`) ?? false));
    return group;
  }

  makeRow(row) {
    const line = document.createElement("div"), id = `control-${row.path.replace(/\W/g, "-")}`;
    line.className = `row ${row.kind}${row.path === "scenario" ? " wide" : ""}`;
    line.innerHTML = `<label for="${id}"></label><span class="entry"></span><p class="fault" id="${id}-fault" role="alert"></p>`;
    line.querySelector("label").append(...nameOf(row));
    if (row.help) line.querySelector("label").title = row.help;
    const parts = { row, line, fault: line.querySelector(".fault") }, entry = line.querySelector(".entry");
    this.rows.set(row.path, parts);
    if (row.kind === "choice") {
      parts.field = document.createElement("select");
      parts.field.addEventListener("change", () => this.enter({ path: row.path, value: parts.field.value }));
      entry.append(parts.field);
      fillChoices(parts.field, row.options);
    } else {
      parts.field = document.createElement("input");
      parts.field.type = "text"; parts.field.spellcheck = false; parts.field.autocomplete = "off";
      if (row.kind === "number" || row.kind === "whole") parts.field.inputMode = "decimal";
      if (row.empty) parts.field.placeholder = row.empty;
      parts.field.addEventListener("change", () => this.enter({ path: row.path, text: parts.field.value }));
      entry.append(parts.field);
      if (row.unit) entry.append(Object.assign(document.createElement("span"), { className: "unit", textContent: row.unit }));
      if (row.range) this.makeSlider(parts, id);
    }
    parts.field.id = id;
    parts.field.setAttribute("aria-describedby", `${id}-fault`);
    return line;
  }

  makeSlider(parts, id) {
    const slider = document.createElement("input");
    Object.assign(slider, { type: "range", min: 0, max: 1000, step: 1, id: `${id}-slider` });
    slider.setAttribute("aria-label", `${parts.row.label || parts.row.letter}, slider`);
    slider.addEventListener("input", () => {
      const value = numberAt(parts.row.range, Number(slider.value));
      parts.field.value = String(value);
      slider.setAttribute("aria-valuetext", `${value} ${parts.row.unit}`);
      this.later({ path: parts.row.path, value });
    });
    parts.slider = slider;
    parts.line.append(slider);
  }

  /** Send the latest value of a slider that moves, at most one a frame, and the next one only when the last one has been heard. */
  later(message) {
    const waits = this.waiting || this.unheard;
    this.waiting = message;
    if (!waits) requestAnimationFrame(() => this.sendWaiting());
  }

  sendWaiting() {
    const message = this.waiting;
    this.waiting = null;
    if (!message) return;
    this.unheard = setTimeout(() => this.heard(), LONGEST_WAIT);
    this.send(message);
  }

  heard() {
    clearTimeout(this.unheard);
    this.unheard = null;
    if (this.waiting) requestAnimationFrame(() => this.sendWaiting());
  }

  fill(path, held) {
    const parts = this.rows.get(path), active = this.root.getRootNode().activeElement;
    const row = Object.assign(parts.row, held);
    if (parts.slider && active !== parts.slider) parts.slider.value = positionOf(row.range, row.value);
    if (parts.slider) parts.slider.setAttribute("aria-valuetext", `${row.text} ${row.unit}`);
    if (active === parts.slider && parts.slider) return; // it is being moved: what it says is newer
    if (active !== parts.field || parts.field.value !== row.text) parts.field.value = row.text;
    parts.field.title = row.text.length > 9 ? row.text : ""; // where a field cannot grow with its number
  }
}

/** The name of a row: words, and the symbol in italics with its index. */
function nameOf({ label, letter, index }) {
  if (!letter) return [label];
  const symbol = Object.assign(document.createElement("i"), { textContent: letter });
  if (index) symbol.append(Object.assign(document.createElement("sub"), { textContent: index }));
  return label ? [`${label} `, symbol] : [symbol];
}

/** Options of a list; those with a group stand under its name. */
function fillChoices(select, options) {
  const groups = new Map();
  for (const { value, label, group } of options) {
    const option = Object.assign(document.createElement("option"), { value, textContent: label });
    if (group && !groups.has(group)) {
      groups.set(group, Object.assign(document.createElement("optgroup"), { label: group }));
      select.append(groups.get(group));
    }
    (groups.get(group) ?? select).append(option);
  }
}

/** Where Panel shows the controls: rows, what they hold, and faults come from Python, and what is entered goes back. */
export function render({ model }) {
  const root = document.createElement("div");
  const controls = new Controls(root, (message) => model.send_msg(message));
  model.on(["groups", "values"], () => controls.update(model.groups, model.values));
  model.on("faults", () => controls.blame(model.faults));
  controls.update(model.groups, model.values);
  controls.blame(model.faults);
  return root;
}

export { Controls };

// The time bar: play, pause, speed, a slider, and marks that can be clicked. It moves the cursor of all panels.

const WHOLE = 12; // seconds in which a run is played at speed 1
const FIRST = 3; // speed at which a page plays its first run by itself
const GLYPHS = { start: "▸", pulse: "▲", arrest: "■", jump: "◆", fold: "○", echo: "│" };
const RANKS = ["arrest", "pulse", "start", "jump", "fold", "echo"]; // of marks at one time, the first gives the sign
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

const icon = (path) => `<svg viewBox="0 0 16 16" width="1em" height="1em" fill="currentColor" aria-hidden="true"><path d="${path}"/></svg>`;
const PLAY = icon("M4 2.5v11l9-5.5z"), PAUSE = icon("M4 2.5h3v11H4zM9 2.5h3v11H9z"), TO_START = icon("M3 2.5h2v11H3zM13 2.5v11L5.5 8z");
const LENS = "M6.5 1.5a5 5 0 1 0 3 9l3.7 3.7 1.1-1.1-3.7-3.7a5 5 0 0 0-4.1-7.9zm0 1.6a3.4 3.4 0 1 1 0 6.8 3.4 3.4 0 0 1 0-6.8z";
const ZOOM_IN = icon(`${LENS}M5.8 4.6h1.4v1.2h1.2v1.4H7.2v1.2H5.8V7.2H4.6V5.8h1.2z`), ZOOM_OUT = icon(`${LENS}M4.6 5.8h3.8v1.4H4.6z`);

const BAR = `
  <div class="bar" role="group" aria-label="Time">
    <button class="start" type="button" aria-label="To the start" title="To the start (Home)">${TO_START}</button>
    <button class="play" type="button" aria-label="Play" title="Play or pause (space)">${PLAY}</button>
    <label class="speed" title="Speed of playing"><span class="hidden">Speed</span>
      <select aria-label="Speed of playing">${SPEEDS.map((one) => `<option value="${one}"${one === 1 ? " selected" : ""}>${one} ×</option>`).join("")}</select>
    </label>
    <output class="clock" aria-live="off" title="Time of the cursor in all panels"></output>
    <div class="track">
      <div class="marks" role="toolbar" aria-label="Marks: pulses, arrest and jumps"></div>
      <input class="time" type="range" min="0" max="1000" step="any" value="0" aria-label="Time of the cursor">
    </div>
    <button class="in" type="button" aria-label="Show less time, around the cursor" title="Show less time, around the cursor (+)">${ZOOM_IN}</button>
    <button class="out" type="button" aria-label="Show more time" title="Show more time (−; 0 shows all)" disabled>${ZOOM_OUT}</button>
    <output class="values" aria-live="off"></output>
  </div>`;

/** The time bar in an element, for the models of one Bokeh document. */
class Player {
  constructor(bokeh, root, look, moved = () => {}) {
    this.models = new Models(bokeh);
    this.bokeh = bokeh; this.look = look; this.moved = moved;
    this.facts = {}; this.t = null; this.playing = false;
    root.innerHTML = BAR;
    const find = (name) => root.querySelector(name);
    this.root = root; this.button = find(".play"); this.slider = find(".time"); this.clock = find(".clock");
    this.values = find(".values"); this.marks = find(".marks"); this.speed = find("select");
    this.button.addEventListener("click", () => this.toggle());
    find(".in").addEventListener("click", () => this.zoom(0.5));
    find(".out").addEventListener("click", () => this.zoom(2));
    find(".start").addEventListener("click", () => this.go(this.start, true));
    this.slider.addEventListener("input", () => { this.pause(); this.go(this.fromShare(this.slider.value / 1000)); });
    this.slider.addEventListener("change", () => this.report());
    this.slider.addEventListener("keydown", (event) => this.key(event, true));
    if (document.querySelector("[data-plots]")) spareStyles(); // in a notebook there are plots of others too
    this.field = document.querySelector("select[data-field]");
    this.field?.addEventListener("change", () => this.showField());
    this.holdPlots();
    this.listenToPage();
  }

  get start() { return this.range?.start ?? 0; }
  get end() { return this.range?.end ?? 1; }
  get range() { return this.models.get("range:time"); }
  fromShare(share) { return this.start + share * (this.end - this.start); }

  /** Show a view: a new answer. The cursor stays at its time as far as the run has it. */
  update(view) {
    showView(this.models, view);
    document.querySelector("[data-plots]")?.setAttribute("data-answered", "");
    this.facts = view.facts;
    this.showField();
    this.showPanels();
    this.root.querySelector(".out").disabled = true; // a new answer is shown whole
    this.showMarks();
    this.t = this.t === null ? this.start : Math.min(Math.max(this.t, this.start), this.end);
    this.draw(); // at once: what is drawn next must not hold the old moment in the new axes
  }

  /** Show what is chosen of the slab: velocity, displacement or stress. */
  showField() {
    const name = this.field?.value ?? "velocity", found = this.facts.fields?.[name];
    const image = this.models.column("field", name);
    if (image !== this.models.column("picture", "image")) {
      const place = ["x", "y", "dw", "dh"].map((one) => [one, this.models.column("field", one)]);
      this.models.put("picture", { image, ...Object.fromEntries(place) });
    }
    if (!found) return; // a block
    this.models.set("colour:field", { low: -found.most, high: found.most });
    const key = document.querySelector("[data-heading=field] li");
    if (key && this.field) key.lastChild.textContent = found.text; // beside the name that is chosen
  }

  /** Bring the cursor to a time in seconds. */
  goSeconds(seconds) {
    this.rest?.();
    if (this.facts.time) this.go(seconds / this.facts.time.size);
  }

  go(t, report = false) {
    this.t = Math.min(Math.max(t, this.start), this.end);
    if (this.frame) { if (report) this.report(); return; }
    this.frame = requestAnimationFrame(() => { this.frame = null; this.draw(); });
    if (report) this.report();
  }

  draw() {
    if (!this.facts.time || this.t === null) return;
    const values = showMoment(this.models, this.facts, this.t);
    const share = (this.t - this.start) / (this.end - this.start || 1);
    this.slider.value = 1000 * share;
    const { unit } = this.facts.time, digits = digitsFor(this.end - this.start);
    this.clock.textContent = `t = ${this.t.toFixed(digits)} ${unit}`;
    this.slider.setAttribute("aria-valuetext", `${this.t.toFixed(digits)} ${unit}`);
    this.values.innerHTML = (this.facts.read ?? []).map(({ column, symbol, unit, offset }) =>
      `<span style="--role: var(--${column})"><i>${offset ? "Δ" : ""}${symbol}</i> ${shortNumber(values[column])} ${unit}</span>`).join("");
  }

  report() { if (this.facts.time) this.moved(this.t * this.facts.time.size); }

  toggle() { this.playing ? this.pause() : this.play(); }

  /** Play the first run of a page once, so that something moves; whatever is touched ends that, and the cursor is at the start again. */
  introduce() {
    if (!document.querySelector("[data-plots]") || matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    this.rest = () => { this.rest = null; this.playing = false; this.showButton(); this.go(this.start); };
    for (const kind of ["pointerdown", "keydown"]) document.addEventListener(kind, () => this.rest?.(), { capture: true, once: true });
    this.play(FIRST);
  }

  play(speed = null) {
    if (this.t >= this.end) this.t = this.start;
    this.playing = true;
    this.showButton();
    let before = performance.now();
    const tick = (now) => {
      if (!this.playing || !this.root.isConnected) return;
      const t = this.t + (now - before) / 1000 * Number(speed ?? this.speed.value) * (this.end - this.start) / WHOLE;
      before = now;
      this.t = Math.min(t, this.end);
      this.draw();
      if (t >= this.end) (this.rest ?? (() => this.pause()))(); else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.showButton();
    this.report();
  }

  showButton() {
    this.button.innerHTML = this.playing ? PAUSE : PLAY;
    this.button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  showMarks() {
    const span = this.end - this.start || 1;
    const marks = (this.facts.marks ?? []).filter(({ time }) => time >= this.start && time <= this.end);
    this.marks.replaceChildren(...together(marks, 0.018 * span).map((mark, i) => {
      const button = document.createElement("button"), text = mark.text;
      button.type = "button"; button.className = mark.kind; button.textContent = GLYPHS[mark.kind] ?? "│";
      button.title = text; button.setAttribute("aria-label", text); button.tabIndex = i ? -1 : 0;
      button.style.setProperty("--share", (mark.time - this.start) / span);
      button.addEventListener("click", () => { this.pause(); this.go(mark.time, true); });
      return button;
    }));
    this.marks.onkeydown = (event) => this.walkMarks(event);
  }

  walkMarks(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const all = [...this.marks.children], here = all.indexOf(event.target), next = all[here + step];
    event.preventDefault(); event.stopPropagation();
    if (next) { event.target.tabIndex = -1; next.tabIndex = 0; next.focus(); next.click(); }
  }

  /** Panels that have nothing to show give their place to others. */
  showPanels() {
    const hidden = new Set(this.facts.hidden ?? []);
    for (const panel of document.querySelectorAll("[data-panel]")) panel.hidden = hidden.has(panel.dataset.panel);
  }

  /** Dragging or clicking in a panel with an axis of time moves the cursor. */
  holdPlots() {
    for (const place of document.querySelectorAll("[data-panel] > .plot")) {
      const texts = (this.models.get(`plot:${place.parentElement.dataset.panel}`)?.tags ?? []).map((tag) => tag?.text).filter(Boolean);
      place.setAttribute("role", "img");
      place.setAttribute("aria-label", texts.join("; "));
    }
    for (const name of [...TIME_PLOTS, ...NEAR_PLOTS]) {
      const plot = this.models.get(`plot:${name}`), time = (x) => (NEAR_PLOTS.includes(name) ? fromNear(this.facts, x) : x);
      for (const kind of ["tap", "panstart", "pan"]) plot?.on_event(kind, (event) => { this.pause(); this.go(time(event.x)); });
      plot?.on_event("panend", () => this.report());
      plot?.on_event("doubletap", () => (NEAR_PLOTS.includes(name) && !this.facts.near?.whole ? this.showNear() : this.zoom(Infinity)));
    }
  }

  /** Show a share of the time that is shown now, around the cursor; at most the whole run. */
  zoom(factor) {
    const { from, to } = this.facts.time ?? {};
    if (from === undefined) return;
    const span = Math.min((this.end - this.start) * factor, to - from), share = (this.t - this.start) / (this.end - this.start || 1);
    const start = Math.min(Math.max(this.t - share * span, from), to - span);
    this.showTimes(start, start + span);
  }

  /** Show in all panels the time that those of slab and energy show. */
  showNear() { this.showTimes(fromNear(this.facts, this.facts.near.from), fromNear(this.facts, this.facts.near.to)); }

  showTimes(start, end) {
    const { from, to } = this.facts.time;
    this.models.set("range:time", { start, end });
    if (this.facts.near?.whole) this.models.set("range:near", { start, end });
    this.showMarks();
    this.draw();
    this.root.querySelector(".out").disabled = end - start >= (to - from) * 0.999999;
  }

  key(event, onSlider = false) {
    const step = (event.shiftKey ? 0.05 : 0.005) * (this.end - this.start);
    const acts = {
      ArrowRight: () => this.go(this.t + step, true), ArrowLeft: () => this.go(this.t - step, true),
      Home: () => this.go(this.start, true), End: () => this.go(this.end, true), " ": () => this.toggle(), "+": () => this.zoom(0.5), "-": () => this.zoom(2), 0: () => this.zoom(Infinity),
    };
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (onSlider) event.stopPropagation();
    if (event.key !== " ") this.pause();
    act();
  }

  /** Keys: space plays or pauses wherever it has no other use; the arrows move the cursor where the panels have the focus. */
  listenToPage() {
    this.onKey = (event) => {
      if (!this.root.isConnected) { document.removeEventListener("keydown", this.onKey); return; }
      const target = event.composedPath()[0];
      const busy = target.closest?.("input, select, textarea, button, a, summary, [contenteditable]");
      const inPanels = event.composedPath().some((one) => one.dataset && "plots" in one.dataset);
      if (!busy && (inPanels || event.key === " ") && (inPanels || target === document.body)) this.key(event);
    };
    document.addEventListener("keydown", this.onKey);
    const switchGround = document.querySelector("[data-switch=ground]");
    this.paint();
    if (switchGround && !switchGround.dataset.heard) {
      switchGround.dataset.heard = "yes";
      switchGround.addEventListener("click", () => {
        chooseGround(document.documentElement.dataset.ground === "dark" ? "light" : "dark");
        this.paint();
      });
    }
    for (const query of ["(min-width: 1700px)", "(max-width: 760px)"]) matchMedia(query).addEventListener("change", () => this.paint());
  }

  paint() {
    const ground = document.documentElement.dataset.ground ?? "light";
    paintModels(this.bokeh, this.look, ground);
    const button = document.querySelector("[data-switch=ground]");
    button?.setAttribute("aria-pressed", String(ground === "dark"));
  }
}

/** Marks at almost the same time are one button, which says what all of them are and goes to the first of the most telling kind. */
function together(marks, near) {
  const found = [];
  for (const mark of marks) {
    const last = found.at(-1);
    if (last && mark.time - last.time <= near) {
      last.text += `; ${mark.text}`;
      if (RANKS.indexOf(mark.kind) < RANKS.indexOf(last.kind)) Object.assign(last, { kind: mark.kind, time: mark.time });
    } else found.push({ ...mark });
  }
  return found;
}

/** Keep changes that are meant for the browser alone from Python. Bokeh's server does so; what Panel puts into a notebook does not. */
function keepFromKernel(bokeh) {
  for (const manager of bokeh.roots().filter((root) => root.client_comm_id !== undefined && root._document_changed)) {
    const tell = manager._document_changed.bind(manager);
    manager._document_changed = (event) => { if (event.sync !== false) tell(event); };
  }
}

/** Where Panel shows the bar: `model.shown` and `model.cursor` come from Python, and the cursor goes back when it rests. */
export function render({ model, view, el }) {
  keepFromKernel(view.model.document);
  const root = document.createElement("div");
  root.className = "player";
  const player = new Player(view.model.document, root, model.look, (seconds) => model.send_msg({ cursor: seconds }));
  let met = false;
  const update = () => {
    if (!model.shown.byteLength) return;
    player.update(readView(model.shown));
    if (!met && !model.cursor.seconds) player.introduce();
    met = true;
  };
  model.on("shown", update);
  model.on("cursor", () => player.goSeconds(model.cursor.seconds));
  update();
  if (model.cursor.seconds) player.goSeconds(model.cursor.seconds);
  return root;
}

export { Player };

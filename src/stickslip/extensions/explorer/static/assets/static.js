// The tour without Python: answers come from the files data/step-N.js, and are brought to the plots as the server would.

/** Whole numbers in base64 as numbers again; the largest one stands for NaN. */
function numbers({ bits, low, high, whole }) {
  const bytes = Uint8Array.from(atob(whole), (one) => one.charCodeAt(0));
  const found = bits === 16 ? new Uint16Array(bytes.buffer) : bytes, most = 2 ** bits - 2;
  return Float32Array.from(found, (one) => (one > most ? NaN : low + (one / most) * (high - low)));
}

const STRIPS = ["pulses", "slip", "first_end", "peak_rate"];

function column(packed) {
  if (Array.isArray(packed)) return packed.map((one) => (one === null ? NaN : Array.isArray(one) ? one.map((inner) => inner ?? NaN) : one));
  const found = numbers(packed);
  return packed.shape ? [window.imageOf(found, packed.shape)] : found;
}

/** A view as the time bar takes it, from one in which columns are packed. */
function unpacked(view) {
  const columns = (packed) => Object.fromEntries(Object.entries(packed).map(([name, one]) => [name, column(one)]));
  return { ...view, columns: Object.fromEntries(Object.entries(view.columns).map(([source, packed]) => [source, columns(packed)])) };
}

const waiting = new Map(), loaded = new Map();
window.stickslipStep = async (step, text) => {
  const bytes = Uint8Array.from(atob(text), (one) => one.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  waiting.get(step)(JSON.parse(await new Response(stream).text()));
};

/** The content of a step, from its file: as a script, because a page from a disk may read no other files. */
function load(step) {
  if (!loaded.has(step)) {
    loaded.set(step, new Promise((done, failed) => {
      waiting.set(step, done);
      const script = document.createElement("script");
      script.src = `data/step-${step}.js`;
      script.onerror = () => { loaded.delete(step); failed(new Error(`data/step-${step}.js is missing from this folder`)); };
      document.head.append(script);
    }));
  }
  return loaded.get(step);
}

/** A part with styles of its own, as Panel gives it. */
function part(selector, css) {
  const shadow = document.querySelector(selector).attachShadow({ mode: "open" }), root = document.createElement("div"), style = document.createElement("style");
  style.textContent = css;
  shadow.append(style, root);
  return root;
}

class Tour {
  constructor(bokeh) {
    this.bokeh = bokeh;
    this.player = new window.Player(bokeh, part("footer.time", PLAYER_CSS), FACTS.look);
    this.card = new window.TourCard(part(".tour", CARD_CSS), FACTS.steps, (step) => this.go(step), false);
    this.words = { texts: { sentence: "" }, on: (_, heard) => { this.tell = heard; }, send_msg: () => {} }; // as Panel's model
    part(".words-place", WORDS_CSS).append(window.Words({ model: this.words }));
    this.slider = document.querySelector("#place");
    this.slider.addEventListener("input", () => this.show(Number(this.slider.value)));
    for (const name of STRIPS) {
      bokeh.get_model_by_name(`plot:strip_${name}`).on_event("tap", (event) => this.goTo(event.x));
    }
    addEventListener("hashchange", () => this.go(this.wanted));
  }

  get wanted() { const step = Number(location.hash.replace("#step-", "")); return FACTS.steps[step - 1] ? step : 1; }

  async go(step) {
    if (step === this.step || !FACTS.steps[step - 1]) return;
    this.asked = step;
    let content;
    try { content = await load(step); } catch (error) { this.say({ fault: error.message }); return; }
    if (this.asked !== step) return; // another step has been asked for since
    this.step = step;
    this.content = content;
    history.replaceState(null, "", `#step-${step}`);
    this.slider.max = content.places.length - 1;
    document.querySelector(".knob label").textContent = content.parameter;
    document.querySelector(".knob p").textContent = content.meaning;
    this.showStrip(content.strip);
    this.show(content.start);
    this.player.pause();
    this.player.goSeconds(content.cursor);
    this.card.show(step);
  }

  /** Show the answer at one place of the strip. */
  show(number) {
    const place = this.content.places[number];
    this.slider.value = number;
    document.querySelector(".knob output").textContent = `${place.value} ${this.content.unit}`.trim();
    this.slider.setAttribute("aria-valuetext", `${place.value} ${this.content.unit}`);
    this.say(place.words);
    for (const name of STRIPS) this.player.models.set(`here:strip_${name}`, { location: place.at });
    this.player.update(unpacked(place.view));
  }

  showStrip(strip) {
    window.showColumns(this.player.models, unpacked(strip));
    for (const [name, html] of Object.entries(strip.headings)) document.querySelector(`[data-heading=${name}]`).innerHTML = html;
  }

  say(texts) { this.words.texts = texts; this.tell(); }

  /** Show the answer whose place on the strip is nearest to a click. */
  goTo(at) {
    const distances = this.content.places.map((place) => Math.abs(place.at - at));
    this.show(distances.indexOf(Math.min(...distances)));
  }
}

(function begin() {
  const bokeh = window.Bokeh?.documents?.[0];
  if (!bokeh || !bokeh.get_model_by_name("source:field")) { setTimeout(begin, 20); return; }
  window.tour = new Tour(bokeh);
  window.tour.go(window.tour.wanted);
})();

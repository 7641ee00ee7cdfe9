// The tour: a card with one step's text, what to look at, and a question; it also marks the panel to look at.

const CARD = `
  <section class="step" aria-label="Guided tour">
    <div class="title"><h2 tabindex="-1"></h2><button type="button" class="close" aria-label="Close the tour" title="Close the tour">✕</button></div>
    <p class="told"></p><p class="look"></p><p class="question"></p>
    <div class="steps">
      <button type="button" class="back" aria-label="Previous step" title="Previous step">‹</button>
      <ol></ol>
      <button type="button" class="next" aria-label="Next step" title="Next step">›</button>
    </div>
  </section>`;

/** The card in an element. `steps` are objects of title, text, look, question and panel; `go(step)` asks for another one. */
class TourCard {
  constructor(root, steps, go) {
    this.root = root; this.steps = steps; this.go = go; this.step = 0;
    root.innerHTML = CARD;
    const find = (name) => root.querySelector(name);
    this.card = find(".step"); this.title = find("h2"); this.dots = find("ol");
    this.back = find(".back"); this.next = find(".next");
    this.back.addEventListener("click", () => this.ask(this.step - 1));
    this.next.addEventListener("click", () => this.ask(this.step + 1));
    find(".close").addEventListener("click", () => this.ask(0));
    this.dots.replaceChildren(...steps.map((step, i) => {
      const item = document.createElement("li"), button = document.createElement("button");
      button.type = "button"; button.textContent = String(i + 1); button.title = step.title;
      button.setAttribute("aria-label", `Step ${i + 1}: ${step.title}`);
      button.addEventListener("click", () => this.ask(i + 1));
      item.append(button);
      return item;
    }));
    this.show(0);
  }

  ask(step) { this.asked = true; this.go(Math.max(0, Math.min(step, this.steps.length))); }

  show(step) {
    this.step = step;
    const found = this.steps[step - 1];
    this.card.hidden = !found;
    for (const panel of document.querySelectorAll("[data-panel]")) panel.toggleAttribute("data-look", panel.dataset.panel === found?.panel);
    if (!found) return;
    this.title.textContent = `${step} of ${this.steps.length}: ${found.title}`;
    for (const [name, text] of [["told", found.text], ["look", found.look], ["question", found.question]]) this.root.querySelector(`.${name}`).textContent = text;
    this.back.disabled = step <= 1;
    this.next.disabled = step >= this.steps.length;
    [...this.dots.querySelectorAll("button")].forEach((button, i) => button.toggleAttribute("aria-current", i + 1 === step));
    if (this.asked) this.title.focus({ preventScroll: true }); // readers of the screen hear the new step
    this.asked = false;
  }
}

/** Where Panel shows the card: `model.step` comes from Python, and a step that is asked for goes back. */
export function render({ model }) {
  const root = document.createElement("div");
  const card = new TourCard(root, model.steps, (step) => model.send_msg({ step }));
  model.on("step", () => card.show(model.step));
  card.show(model.step);
  return root;
}

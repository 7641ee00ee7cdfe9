// The bar above a strip: which parameter moves, and how far. What is chosen goes to Python.

const STRIP_BAR = `
  <div class="strip-row" role="group" aria-label="Strip: many runs of one parameter">
    <label>Strip of 200 runs over <select class="parameter" aria-label="Parameter of the strip"></select></label>
    <span class="range">
      <label>from <input class="low" type="text" inputmode="decimal" aria-label="Smallest value"></label>
      <label>to <input class="high" type="text" inputmode="decimal" aria-label="Largest value"></label> <span class="unit"></span>
      <label><input class="log" type="checkbox"> logarithmic</label>
    </span>
    <span class="said" aria-live="polite"></span>
  </div>`;

export function render({ model }) {
  const root = document.createElement("div");
  root.innerHTML = STRIP_BAR;
  const find = (name) => root.querySelector(name);
  const [parameter, low, high, log] = [".parameter", ".low", ".high", ".log"].map(find);
  const show = () => {
    const { choices, chosen } = model.state;
    const options = [["", "no parameter"], ...choices.map((name) => [name, name])];
    parameter.replaceChildren(...options.map(([value, text]) => new Option(text, value, false, value === (chosen?.parameter ?? ""))));
    find(".range").hidden = !chosen;
    document.querySelector(".strip")?.toggleAttribute("data-open", Boolean(chosen));
    find(".said").textContent = find(".said").title = model.state.said ?? "";
    if (!chosen) return;
    low.value = chosen.low; high.value = chosen.high; log.checked = chosen.log;
    find(".unit").textContent = chosen.unit;
  };
  parameter.addEventListener("change", () => model.send_msg({ parameter: parameter.value }));
  for (const field of [low, high, log]) {
    field.addEventListener("change", () => model.send_msg({ parameter: parameter.value, low: low.value, high: high.value, log: log.checked }));
  }
  model.on("state", show);
  show();
  return root;
}

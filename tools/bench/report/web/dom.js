// Elements of the page and words for screen readers.

/**
 * @template {keyof HTMLElementTagNameMap} Name
 * @param {Name} name
 * @param {Record<string, string>} [attributes]
 * @param {...(Node | string)} children
 * @returns {HTMLElementTagNameMap[Name]}
 */
function make(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

/** @type {(name: string, attributes: Record<string, string | number>, ...children: (Node | string)[]) => SVGElement} */
function makeSvg(name, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  element.append(...children);
  return element;
}

/** @type {(press: () => void, attributes: Record<string, string>, ...content: (Node | string)[]) => HTMLElement} */
function makeButton(press, attributes, ...content) {
  const button = make("button", { type: "button", ...attributes }, ...content);
  button.addEventListener("click", press);
  return button;
}

/** An event in words, for screen readers. @type {(text: string) => void} */
function say(text) {
  let holder = document.getElementById("status");
  if (!holder) {
    holder = make("div", { id: "status", role: "status", class: "unseen" });
    document.body.append(holder);
  }
  holder.textContent = text;
}

/** Six digits, the precision of a 32-bit float. @type {(value: number | undefined) => string} */
function exact(value = NaN) {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? "–" : value > 0 ? "∞" : "−∞";
  return String(Number(value.toPrecision(6))).replace(/-/g, "−");
}

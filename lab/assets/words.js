"use strict";

// Words beside a picture: its lines by name, and their values under the cursor.
const words = (() => {
  const { scale, fixed } = numbers;

  function swatch({ stroke, dash, dots }) {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    for (const [name, value] of Object.entries({ width: 22, height: 8, "aria-hidden": "true" })) svg.setAttribute(name, value);
    const look = { x1: 0, x2: 22, y1: 4, y2: 4, stroke, "stroke-width": dots ? 5 : 2.5, "stroke-dasharray": dots ? "0.1 11" : dash?.length ? dash.join(" ") : "none", "stroke-linecap": dots ? "round" : "butt" };
    for (const [name, value] of Object.entries(look)) line.setAttribute(name, value);
    svg.append(line);
    return svg;
  }

  function element(name, properties, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  }

  // A row of names, each with room for its value under the cursor.
  function legend(at, spec) {
    const items = spec.lines.map((line) => {
      const value = element("span", { className: "value" });
      return { line, value, item: element("span", { className: "item" }, swatch(line), element("span", { className: "name" }, line.name), value) };
    });
    at.replaceChildren(...items.map(({ item }) => item));
    return (row) => items.forEach(({ line, value }) => { value.textContent = reading(line, row, spec.unit); });
  }

  function reading({ values, halfWidths }, row, unit) {
    const value = row == null ? null : values[row];
    if (value == null) return "";
    const half = halfWidths?.[row];
    const { factor, prefix } = scale(Math.max(Math.abs(value), half ?? 0));
    const leading = (half || Math.abs(value)) / factor;
    const digits = (half ? 1 : 3) - (leading > 0 ? Math.floor(Math.log10(leading)) : 0);
    const interval = half == null ? "" : ` ± ${fixed(half / factor, digits)}`;
    return `${fixed(value / factor, digits)}${interval} ${prefix}${unit}`;
  }

  return { element, legend };
})();

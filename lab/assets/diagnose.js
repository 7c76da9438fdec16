"use strict";

// The report: what is drawn of a trial once it is opened, and which stretch of time.
(() => {
  const { bytes, doubles, floats, fixed, place, scale } = numbers;
  const { element, legend } = words;
  const description = JSON.parse(document.getElementById("description").textContent);
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const LOOK = { measured: "--signal", given: "--given", refitted: "--refitted", improved: "--improved", learned: "--learned" };
  const folds = [...document.querySelectorAll("details.trial")];
  const open = new Map();

  // ---- data

  function load({ id, channel, rows }) {
    const seen = bytes(`t${id}-seen`);
    // What was not seen whole is a gap, and so is what is no number.
    const column = (name) => Array.from(floats(`t${id}-${name}`), (value, i) => (seen[i] && isFinite(value) ? value : null));
    const trace = { id, channel, rows, time: Array.from(doubles(`t${id}-time`)), depth: column("depth"), measured: column("measured"), floor: column("floor") };
    for (const { key } of description.lines) trace[key] = column(key);
    return trace;
  }

  const minus = (a, b) => a.map((value, i) => (value == null || b[i] == null ? null : value - b[i]));

  // ---- pictures

  const DASHES = { given: [6, 4], learned: [10, 3, 2, 3] };
  const line = (key, name, values) => ({ name, values, stroke: css(LOOK[key]), dash: DASHES[key] ?? [], best: key === "improved" || key === "learned" });

  function model(trace, hidden) {
    const simulated = description.lines.filter(({ key }) => !hidden.has(key)).map(({ key, name }) => line(key, name, trace[key]));
    return { short: trace.channel, unit: description.force, height: 250, lines: [...simulated, { ...line("measured", "measured", trace.measured), dots: true }] };
  }

  function residual(trace, hidden) {
    const compared = description.lines.filter(({ key }) => description.compared.includes(key) && !hidden.has(key));
    const edge = (sign) => trace.floor.map((value) => (value == null ? null : 2 * sign * value));
    return {
      short: "left over", unit: description.force, height: 190, reference: 0, words: "",
      corridor: { low: edge(-1), high: edge(1), fill: css("--corridor") },
      lines: compared.map(({ key, name }) => line(key, name, minus(trace.measured, trace[key]))),
    };
  }

  const depth = (trace) => ({ short: "depth", unit: description.position, height: 150, reference: 0, words: "surface", lines: [line("measured", "depth", trace.depth)], last: true });
  const position = (trace) => ({ short: "position", unit: description.position, height: 150, lines: [line("measured", "position", trace.depth)], last: true });

  function copy(name) {
    return document.getElementById(name).content.cloneNode(true);
  }

  // The figures of a trial: two a channel, and the depth once.
  function figures(view) {
    const made = [];
    const add = (template, trace, specs) => {
      const part = copy(template);
      [...part.querySelectorAll("figure")].forEach((figure, i) => made.push({ figure, trace, spec: specs[i] }));
      view.at.append(part);
    };
    for (const trace of view.traces) add(`figures-${trace.channel}`, trace, [model, residual]);
    if (view.touches) add("figures-depth", view.traces.find(({ channel }) => channel === "force"), [depth]);
    else add("figures-position", view.traces[0], [position]);
    return made;
  }

  function draw(view) {
    view.charts.forEach(({ plot }) => plot.destroy());
    const hooks = { zoom: (from, to) => zoom(view, from, to), whole: () => zoom(view, ...view.ends) };
    view.charts = view.figures.map(({ figure, trace, spec }) => {
      const drawn = spec(trace, view.hidden);
      const tell = legend(figure.querySelector(".legend"), drawn);
      const touches = view.places.filter(({ channel }) => channel === trace.channel || spec === depth || spec === position).map(({ start, end }) => [start, end]);
      const shared = { time: trace.time, since: "time since the first row, s", touches, width: width(figure), key: `trial-${view.index}` };
      const cursor = (row) => { tell(row); clock(view, row == null ? null : trace.time[row]); };
      return { ...chart.draw(drawn, shared, { ...hooks, cursor }, figure.querySelector(".plot")), trace, figure };
    });
    show(view);
  }

  // Before printing the layout is still the screen's; 700 px is an A4 page between its margins.
  const onPaper = () => document.documentElement.classList.contains("paper");
  const width = (figure) => (onPaper() ? 700 : Math.max(260, Math.floor(figure.querySelector(".plot").clientWidth)));

  function show(view) {
    for (const one of view.charts) {
      const { time } = one.trace;
      one.show(view.span, [Math.max(0, place(time, view.span[0]) - 1), Math.min(time.length, place(time, view.span[1]) + 1)], true);
    }
    const whole = view.span[0] <= view.ends[0] && view.span[1] >= view.ends[1];
    view.at.querySelector(".whole").setAttribute("aria-pressed", whole);
    const worst = worstSpan(view);
    view.at.querySelector(".worst")?.setAttribute("aria-pressed", !!worst && worst.every((end, i) => end === view.span[i]));
  }

  function clock(view, time) {
    const digits = 4 - Math.floor(Math.log10(view.span[1] - view.span[0]));
    view.at.querySelector(".clock").textContent = time == null ? "drag to zoom" : `t = ${fixed(time, digits)} s`;
  }

  // ---- time

  function zoom(view, from, to) {
    const [first, last] = view.ends;
    if (to - from < (last - first) * 1e-6) return;
    view.span = [Math.max(first, from), Math.min(last, to)];
    show(view);
  }

  // What shows the answer, or the largest place, with as much again around it: what is off is seen beside what is not.
  function worstSpan({ places, opens, ends, traces }) {
    if (places.length === 0 && !opens) return null;
    // A stretch as long as the trial is no closer look.
    const isShort = opens && opens[1] - opens[0] < 0.5 * (ends[1] - ends[0]);
    if (!isShort && places.length === 0) return null;
    const [start, end] = isShort ? opens : [places[0].start, places[0].end];
    const { time } = traces[0];
    const row = (ends[1] - ends[0]) / Math.max(1, time.length);
    const margin = Math.max(0.5 * (end - start), 10 * row);
    const [from, to] = [Math.max(ends[0], start - margin), Math.min(ends[1], end + margin)];
    return to > from ? [from, to] : null;
  }

  function move(view, how) {
    const [from, to] = view.span;
    const [first, last] = view.ends;
    const quarter = (to - from) / 4;
    const back = Math.min(2 * quarter, from - first), forth = Math.min(2 * quarter, last - to);
    const moves = {
      back: [from - back, to - back], forth: [from + forth, to + forth],
      in: [from + quarter, to - quarter], out: [from - 2 * quarter, to + 2 * quarter],
      all: view.ends, worst: worstSpan(view) ?? view.ends,
    };
    zoom(view, ...moves[how]);
  }

  // ---- choices

  function toolbar(view) {
    const bar = view.at.querySelector(".toolbar");
    bar.querySelector(".lines").append(...description.lines.map(({ key, name }) => {
      const box = element("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => {
        if (box.checked) view.hidden.delete(key); else view.hidden.add(key);
        draw(view);
      });
      return element("label", { className: "chip" }, box, element("span", { className: `key ${key}` }), name);
    }));
    if (!worstSpan(view)) bar.querySelector(".worst").remove();
    bar.querySelectorAll("[data-move]").forEach((button) => button.addEventListener("click", () => move(view, button.dataset.move)));
  }

  function told({ traces }, fold) {
    const at = fold.querySelector(".rows");
    const [shown, all] = [Math.max(...traces.map(({ time }) => time.length)), Number(at.dataset.rows)];
    at.textContent = shown < all ? `${shown} of ${all} samples are in this page: all of the largest places that fit, and elsewhere the extremes of every stretch of time.` : "";
  }

  // ---- trials

  function begin(fold) {
    const index = Number(fold.dataset.trial);
    const { traces, places, opens, touches } = description.trials[index];
    const view = { index, places, opens, touches, traces: traces.map(load), at: fold.querySelector(".pictures"), charts: [], hidden: new Set() };
    const times = view.traces.map(({ time }) => [time[0], time[time.length - 1]]);
    const [first, last] = [Math.min(...times.map(([t]) => t)), Math.max(...times.map(([, t]) => t))];
    view.ends = last > first ? [first, last] : [first - 0.5, first + 0.5];
    view.at.replaceChildren(copy("toolbar"));
    view.figures = figures(view);
    toolbar(view);
    view.span = worstSpan(view) ?? view.ends;
    told(view, fold);
    open.set(fold, view);
    draw(view);
  }

  function end(fold) {
    open.get(fold)?.charts.forEach(({ plot }) => plot.destroy());
    open.delete(fold);
    fold.querySelector(".pictures").replaceChildren();
  }

  for (const fold of folds) {
    fold.addEventListener("toggle", () => (fold.open ? open.has(fold) || begin(fold) : end(fold)));
    if (fold.open) begin(fold);
  }

  let known = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === known) return;
    known = innerWidth;
    open.forEach(({ charts }) => charts.forEach(({ plot, figure }) => plot.setSize({ width: width(figure), height: plot.height })));
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => open.forEach((view) => draw(view)));
  // Paper is white and narrow whatever the screen is.
  for (const [event, paper] of [["beforeprint", true], ["afterprint", false]]) {
    addEventListener(event, () => {
      document.documentElement.classList.toggle("paper", paper);
      open.forEach((view) => draw(view));
    });
  }
})();

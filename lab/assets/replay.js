"use strict";

// The page: which recording is open, which methods and which stretch of time its pictures show.
(() => {
  const { bytes, doubles, floats, scale, fixed, place } = numbers;
  const { element, legend } = words;
  const description = JSON.parse(document.getElementById("description").textContent);
  const articles = [...document.querySelectorAll("article.trial")];

  // Choices outlive the change of a recording; methods are known by name since not every recording has all.
  const chosen = { hidden: new Set(), bands: null, full: false };
  let open = null;

  // ---- data

  function load(index) {
    const trial = description.trials[index];
    const contact = bytes(`t${index}-contact`);
    const clock = doubles(`t${index}-time`);
    // Ten digits under every tick read worse than one origin: a clock that counts from an epoch is shown from its start.
    const origin = Math.abs(clock[0]) >= 1e5 ? clock[0] : 0;
    const time = Array.from(clock, (seconds) => seconds - origin);
    // Out of contact nothing is estimated: a gap, not a line at zero. So are values that are no numbers.
    const column = (name, everywhere) =>
      Array.from(floats(`t${index}-${name}`), (value, i) => (isFinite(value) && (everywhere || contact[i]) ? value : null));
    const methods = trial.methods.map((method, number) => {
      const own = (name) => column(`m${number}-${name}`);
      return {
        ...method, best: number === trial.best,
        stiffness: own("stiffness"), stiffnessHalfWidth: own("stiffness-half-width"),
        damping: own("damping"), dampingHalfWidth: own("damping-half-width"), innovation: own("innovation"),
      };
    });
    return { ...trial, time, origin, methods, penetration: column("penetration", true), force: column("force", true), touches: touches(time, contact) };
  }

  function touches(time, contact) {
    const found = [];
    for (let i = 0; i < time.length; i++) {
      if (!contact[i]) continue;
      const start = time[i];
      while (i < time.length && contact[i]) i++;
      found.push([start, time[Math.min(i, time.length - 1)]]);
    }
    return found;
  }

  // ---- pictures

  function specs(trial) {
    const { units } = trial;
    const shown = trial.methods.filter((method) => !chosen.hidden.has(method.name));
    const style = (method) => ({ name: method.name, stroke: chart.colour(method), dash: chart.dash(method), best: method.best });
    const plain = (values) => [{ name: "", values, stroke: getComputedStyle(document.documentElement).getPropertyValue("--signal").trim() }];
    const banded = (method) => chosen.bands === "all" || chosen.bands === method.name;
    const estimates = (values, halfWidths) =>
      shown.map((method) => ({ ...style(method), values: method[values], halfWidths: method[halfWidths], banded: banded(method) }));
    const nominal = (value, unit) => {
      const { factor, prefix } = scale(Math.abs(value));
      return { reference: value, words: `rig file: ${Number((value / factor).toPrecision(4))} ${prefix}${unit}` };
    };
    return {
      position: { short: "depth", unit: units.position, lines: plain(trial.penetration), reference: 0, words: "surface" },
      force: { short: "force", unit: units.force, lines: plain(trial.force) },
      stiffness: { short: "K", unit: units.stiffness, lines: estimates("stiffness", "stiffnessHalfWidth"), ...nominal(trial.nominal_stiffness, units.stiffness) },
      damping: { short: "B", unit: units.damping, lines: estimates("damping", "dampingHalfWidth"), ...nominal(trial.nominal_damping, units.damping) },
      innovation: { short: "innovation", unit: units.force, lines: shown.map((method) => ({ ...style(method), values: method.innovation })), reference: 0, words: "", last: true },
    };
  }

  function draw() {
    const { trial, section } = open;
    open.charts?.forEach(({ plot }) => plot.destroy());
    const since = trial.origin ? `time since ${trial.origin} s, s` : "time, s";
    const shared = { time: trial.time, since, touches: trial.touches, width: width() };
    const hooks = { zoom, whole, cursor };
    const all = specs(trial);
    open.legends = [];
    open.charts = [...section.querySelectorAll("figure")].map((figure) => {
      const spec = all[figure.dataset.chart];
      open.legends.push(legend(figure.querySelector(".legend"), spec));
      return chart.draw(spec, shared, hooks, figure.querySelector(".plot"));
    });
    show();
  }

  // Before printing the layout is still the screen's; 700 px is an A4 page between its margins.
  const onPaper = () => document.documentElement.classList.contains("paper");
  const width = () => (onPaper() ? 700 : Math.max(280, Math.floor(open.section.querySelector(".plot").clientWidth)));

  function show() {
    const { trial, span } = open;
    const rows = [Math.max(0, place(trial.time, span[0]) - 1), Math.min(trial.time.length, place(trial.time, span[1]) + 1)];
    for (const one of open.charts) one.show(span, rows, chosen.full);
  }

  // ---- time

  const ends = () => {
    const { time } = open.trial;
    const [first, last] = [time[0], time[time.length - 1]];
    return last > first ? [first, last] : [first - 0.5, first + 0.5];
  };

  function zoom(from, to) {
    const [first, last] = ends();
    const shortest = (last - first) * 1e-6;
    if (to - from < shortest) return;
    open.span = [Math.max(first, from), Math.min(last, to)];
    show();
  }

  function whole() {
    open.span = ends();
    show();
  }

  function move(how) {
    const [from, to] = open.span;
    const [first, last] = ends();
    const length = to - from;
    const quarter = length / 4;
    const back = Math.min(2 * quarter, from - first), forth = Math.min(2 * quarter, last - to);
    const moves = {
      back: () => zoom(from - back, to - back), forth: () => zoom(from + forth, to + forth),
      in: () => zoom(from + quarter, to - quarter), out: () => zoom(from - 2 * quarter, to + 2 * quarter), all: whole,
    };
    moves[how]();
  }

  // ---- words beside the pictures

  function cursor(row) {
    if (!open?.legends || open.row === row) return;
    open.row = row;
    open.legends.forEach((tell) => tell(row));
    open.section.querySelector(".clock").textContent = row == null ? "drag to zoom" : `t = ${fixed(open.trial.time[row], 4 - Math.floor(Math.log10(open.span[1] - open.span[0])))} s`;
  }

  // ---- choices

  function toolbar(trial, section) {
    const bar = section.querySelector(".toolbar");
    bar.querySelector(".methods").append(...trial.methods.map((method) => {
      const box = element("input", { type: "checkbox", checked: !chosen.hidden.has(method.name) });
      box.addEventListener("change", () => {
        if (box.checked) chosen.hidden.delete(method.name); else chosen.hidden.add(method.name);
        draw();
      });
      const key = element("span", { className: `key c${method.colour % 9}` });
      return element("label", { className: "chip", title: method.title }, box, key, method.name);
    }));
    bands(bar.querySelector(".bands"), trial);
    const range = bar.querySelector(".range");
    range.setAttribute("aria-pressed", chosen.full);
    range.addEventListener("click", () => {
      chosen.full = !chosen.full;
      range.setAttribute("aria-pressed", chosen.full);
      show();
    });
    bar.querySelectorAll("[data-move]").forEach((button) => button.addEventListener("click", () => move(button.dataset.move)));
  }

  function bands(select, trial) {
    const names = trial.methods.map((method) => method.name);
    // More than a few bands over each other show none of them.
    chosen.bands ??= names.length <= 3 ? "all" : names[trial.best ?? 0] ?? "none";
    const value = [...names, "all", "none"].includes(chosen.bands) ? chosen.bands : "all";
    select.append(new Option("all", "all"), new Option("none", "none"), ...names.map((name) => new Option(`of ${name}`, name)));
    select.value = value;
    select.addEventListener("change", () => { chosen.bands = select.value; draw(); });
  }

  // ---- recordings

  function close() {
    open?.charts.forEach(({ plot }) => plot.destroy());
    open?.section.replaceChildren();
    open = null;
  }

  function choose(index) {
    close();
    articles.forEach((article, i) => { article.hidden = i !== index; });
    document.querySelectorAll("#recordings tbody tr").forEach((row, i) => {
      row.classList.toggle("open", i === index);
      row.querySelector("a").toggleAttribute("aria-current", i === index);
    });
    const section = articles[index]?.querySelector(".pictures");
    if (!section) return;
    section.replaceChildren(
      document.getElementById("toolbar").content.cloneNode(true),
      document.getElementById("figures").content.cloneNode(true),
    );
    open = { trial: load(index), section };
    open.span = ends();
    toolbar(open.trial, section);
    if (open.trial.methods.length === 0 || open.trial.touches.length === 0) {
      ["stiffness", "damping", "innovation"].forEach((key) => section.querySelector(`[data-chart=${key}]`).remove());
    }
    draw();
  }

  const asked = () => Math.max(0, Number(/^#trial-(\d+)$/.exec(location.hash)?.[1] ?? 1) - 1);

  function follow() {
    const index = Math.min(asked(), articles.length - 1);
    if (index >= 0) choose(index);
    // The recording was hidden when the browser looked for it.
    if (/^#trial-/.test(location.hash)) articles[index]?.scrollIntoView();
  }

  addEventListener("hashchange", follow);
  follow();

  let known = innerWidth;
  addEventListener("resize", () => {
    if (!open || innerWidth === known) return;
    known = innerWidth;
    open.charts.forEach(({ plot }) => plot.setSize({ width: width(), height: plot.height }));
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => open && draw());
  // Paper is white and narrow whatever the screen is.
  for (const [event, paper] of [["beforeprint", true], ["afterprint", false]]) {
    addEventListener(event, () => {
      document.documentElement.classList.toggle("paper", paper);
      if (open) draw();
    });
  }
})();

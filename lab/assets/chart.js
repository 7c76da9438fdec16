"use strict";

// One picture: its lines, its range and how it is drawn.
const chart = (() => {
  const { scale, fixed, decimals, quantile } = numbers;
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Beyond the ninth method colours repeat; from the fifth on dashes tell apart what hues alone may not.
  const colour = (method) => css(`--c${method.colour % 9}`);
  const dash = (method) => (method.colour % 9 >= 4 ? [7, 3] : []);

  // Numbers of `values` between two rows, sorted.
  function sorted(values, from, to) {
    const kept = [];
    for (let i = from; i < to; i++) if (values[i] != null && isFinite(values[i])) kept.push(values[i]);
    return Float64Array.from(kept).sort();
  }

  function extent(lines, from, to) {
    let low = Infinity, high = -Infinity;
    for (const { values } of lines) {
      for (let i = from; i < to; i++) {
        const value = values[i];
        if (value == null || !isFinite(value)) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    return [low, high];
  }

  // What a line usually does. An estimator thrown about by an onset has wide intervals there, so samples far less
  // certain than usual do not count; the outermost twentieths do not either.
  function usual({ values, halfWidths }, from, to) {
    let settled = values;
    let margin = 0;
    if (halfWidths) {
      const widths = sorted(halfWidths, from, to);
      if (widths.length > 0) {
        margin = quantile(widths, 0.5);
        settled = values.map((value, i) => (halfWidths[i] <= 3 * margin ? value : null));
      }
    }
    const kept = sorted(settled, from, to);
    if (kept.length === 0) return null;
    const share = halfWidths ? 0.05 : 0.01;
    let [low, high] = [quantile(kept, share) - margin, quantile(kept, 1 - share) + margin];
    if (halfWidths) {
      // A steady estimate shall look steady, not like noise blown up to the height of the picture.
      const calm = 0.1 * Math.abs(quantile(kept, 0.5));
      [low, high] = [Math.min(low, quantile(kept, 0.5) - calm), Math.max(high, quantile(kept, 0.5) + calm)];
    }
    return [low, high];
  }

  // The best method sets the range; the others may widen it, though not so far that the best is flattened.
  function typical(lines, reference, from, to) {
    const ranges = lines.map((line) => usual(line, from, to));
    const first = Math.max(0, lines.findIndex((line, i) => line.best && ranges[i]));
    const core = ranges[first] ?? ranges.find(Boolean);
    if (!core) return extent(lines, from, to);
    let [low, high] = core;
    if (reference != null && Math.abs(reference) <= 4 * Math.max(Math.abs(low), Math.abs(high))) {
      [low, high] = [Math.min(low, reference), Math.max(high, reference)];
    }
    const reach = 1.5 * Math.max(high - low, 0.1 * Math.max(Math.abs(low), Math.abs(high)));
    const [floor, ceiling] = [low - reach, high + reach];
    for (const range of ranges) {
      if (!range) continue;
      low = Math.max(floor, Math.min(low, range[0]));
      high = Math.min(ceiling, Math.max(high, range[1]));
    }
    // A signal without outliers is shown whole.
    const [least, greatest] = extent(lines, from, to);
    const slack = 0.6 * (high - low);
    return [least > low - slack ? Math.min(low, least) : low, greatest < high + slack ? Math.max(high, greatest) : high];
  }

  function everything({ lines, reference, corridor }, from, to) {
    const edges = corridor ? [{ values: corridor.low }, { values: corridor.high }] : [];
    const [low, high] = extent([...lines, ...edges], from, to);
    return reference == null ? [low, high] : [Math.min(low, reference), Math.max(high, reference)];
  }

  function padded([low, high]) {
    if (!(low <= high)) return [-1, 1];
    const margin = 0.08 * (high - low) || 0.1 * Math.abs(high) || 1;
    return [low - margin, high + margin];
  }

  function axes(title, unit, last, since) {
    const common = () => ({ stroke: css("--muted"), grid: { stroke: css("--grid"), width: 1 }, ticks: { show: false }, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif" });
    const reach = (u) => Math.max(Math.abs(u.scales.y.min), Math.abs(u.scales.y.max));
    const time = { ...common(), values: (u, ticks, i, space, step) => ticks.map((t) => fixed(t, decimals(step))), size: 28, space: 70 };
    if (last) Object.assign(time, { label: since, labelSize: 20 });
    const values = (u, ticks, i, space, step) => {
      const { factor } = scale(reach(u));
      return ticks.map((tick) => fixed(tick / factor, decimals(step / factor)));
    };
    const label = (u) => `${title}, ${scale(reach(u)).prefix}${unit}`;
    return [time, { ...common(), values, label, labelSize: 20, size: 48, space: 34 }];
  }

  function shade(u, touches) {
    const { left, top, width, height } = u.bbox;
    u.ctx.save();
    u.ctx.beginPath();
    u.ctx.rect(left, top, width, height);
    u.ctx.clip();
    u.ctx.fillStyle = css("--contact");
    for (const [start, end] of touches) {
      if (end < u.scales.x.min || start > u.scales.x.max) continue;
      const from = u.valToPos(start, "x", true);
      u.ctx.fillRect(from, top, Math.max(1, u.valToPos(end, "x", true) - from), height);
    }
    u.ctx.restore();
  }

  function rule(u, value, words) {
    const { left, top, width, height } = u.bbox;
    const y = Math.round(u.valToPos(value, "y", true));
    if (!(y >= top && y <= top + height)) return;
    const { ctx } = u;
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = css("--ink");
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
    ctx.beginPath();
    ctx.moveTo(left, y);
    ctx.lineTo(left + width, y);
    ctx.stroke();
    ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textAlign = "right";
    ctx.textBaseline = "alphabetic";
    // A halo keeps the words readable over the lines they fall on.
    ctx.setLineDash([]);
    ctx.lineWidth = 4 * devicePixelRatio;
    ctx.strokeStyle = css("--paper");
    const above = y > top + 18 * devicePixelRatio;
    const at = [left + width - 6 * devicePixelRatio, y + (above ? -5 : 13) * devicePixelRatio];
    ctx.strokeText(words, ...at);
    ctx.fillText(words, ...at);
    ctx.restore();
  }

  // `spec`: title, unit, lines, reference and its words, a corridor behind the lines, height, last; `shared`: time,
  // width, what to shade and the key of the pictures that move together; `hooks`: whom to tell of cursor and zoom.
  function draw(spec, shared, hooks, place) {
    const series = [{}];
    const data = [shared.time];
    const bands = [];
    for (const line of spec.lines) {
      if (!line.halfWidths) continue;
      const edge = { show: line.banded, stroke: "transparent", width: 0, points: { show: false } };
      const at = (sign) => line.values.map((value, i) => (value == null || line.halfWidths[i] == null ? null : value + sign * line.halfWidths[i]));
      data.push(at(1), at(-1));
      series.push(edge, { ...edge });
      bands.push({ series: [series.length - 2, series.length - 1], fill: line.stroke + "40" });
    }
    if (spec.corridor) {
      const edge = { stroke: "transparent", width: 0, points: { show: false } };
      data.push(spec.corridor.high, spec.corridor.low);
      series.push(edge, { ...edge });
      bands.push({ series: [series.length - 2, series.length - 1], fill: spec.corridor.fill });
    }
    // The best is drawn over the others, and what was measured over all.
    const rank = (line) => (line.dots ? 2 : line.best ? 1 : 0);
    for (const line of [...spec.lines].sort((a, b) => rank(a) - rank(b))) {
      data.push(line.values);
      // What was measured is points: a line would claim what lies between them.
      const look = line.dots ? { width: 0, points: { show: true, size: 3, width: 0, fill: line.stroke } } : { width: line.best ? 2 : 1.4, dash: line.dash, points: { show: false } };
      series.push({ stroke: line.stroke, ...look });
    }
    const plot = new uPlot({
      width: shared.width, height: (spec.height ?? 218) + (spec.last ? 20 : 0), series, bands,
      axes: axes(spec.short, spec.unit, spec.last, shared.since),
      padding: [10, 12, 0, 0],
      legend: { show: false },
      scales: { x: { time: false, auto: false, range: (u, low, high) => [low, high] }, y: { auto: false, range: (u, low, high) => [low, high] } },
      cursor: {
        y: false, points: { show: false },
        drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => hooks.whole() },
        sync: { key: shared.key ?? "palpate", setSeries: false, scales: ["x", null], filters: { pub: (type) => type !== "mousedown" && type !== "mouseup" && type !== "dblclick" } },
      },
      hooks: {
        drawClear: [(u) => shade(u, shared.touches)],
        draw: [(u) => spec.reference != null && rule(u, spec.reference, spec.words)],
        setCursor: [(u) => hooks.cursor(u.cursor.idx)],
        setSelect: [(u) => {
          if (u.select.width < 4) return;
          hooks.zoom(u.posToVal(u.select.left, "x"), u.posToVal(u.select.left + u.select.width, "x"));
          u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
        }],
      },
    }, data, place);

    return {
      plot,
      show([from, to], rows, full) {
        const range = full ? everything(spec, ...rows) : typical(spec.lines, spec.reference, ...rows);
        const empty = !(range[0] <= range[1]);
        const [min, max] = padded(empty && spec.reference != null ? [spec.reference, spec.reference] : range);
        plot.batch(() => {
          plot.setScale("x", { min: from, max: to });
          plot.setScale("y", { min, max });
        });
      },
    };
  }

  return { draw, colour, dash };
})();

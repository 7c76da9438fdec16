"use strict";

// Columns out of the page, figures into words.
const numbers = (() => {
  const PREFIXES = { "-15": "f", "-12": "p", "-9": "n", "-6": "µ", "-3": "m", 0: "", 3: "k", 6: "M", 9: "G" };

  function bytes(id) {
    const text = atob(document.getElementById(id).textContent);
    const buffer = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) buffer[i] = text.charCodeAt(i);
    return buffer;
  }

  const doubles = (id) => new Float64Array(bytes(id).buffer);
  const floats = (id) => new Float32Array(bytes(id).buffer);

  // The prefix under which numbers up to `size` read best.
  function scale(size) {
    const power = size > 0 && isFinite(size) ? Math.floor(Math.log10(size * 1.00005) / 3) * 3 : 0;
    const exponent = Math.min(9, Math.max(-15, power));
    return { factor: 10 ** exponent, prefix: PREFIXES[exponent] };
  }

  const fixed = (value, decimals) => {
    const text = value.toFixed(Math.min(9, Math.max(0, decimals)));
    return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
  };

  // As few decimals as write every multiple of `step` in full: 0.25 needs two.
  function decimals(step) {
    for (let d = 0; d < 9; d++) {
      const scaled = step * 10 ** d;
      if (Math.abs(scaled - Math.round(scaled)) < 1e-6 * scaled) return d;
    }
    return 9;
  }

  // The first place at which sorted `list` is not below `value`.
  function place(list, value) {
    let low = 0, high = list.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (list[middle] < value) low = middle + 1; else high = middle;
    }
    return low;
  }

  const quantile = (sorted, share) => sorted[Math.round(share * (sorted.length - 1))];

  return { bytes, doubles, floats, scale, fixed, decimals, place, quantile };
})();

// What a test asks of a page; every answer is a list of what is wrong, empty where nothing is.
window.checks = (() => {
  const settled = () => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 0))));
  const openAll = () => document.querySelectorAll("details").forEach(one => { one.open = true; });
  const close = () => document.querySelectorAll("details").forEach(one => { one.open = false; });
  const shown = one => one.getClientRects().length > 0;
  const named = one => (one.textContent || "").trim().replace(/\s+/g, " ").slice(0, 60);
  const meet = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.25 * Math.min(a.height, b.height);

  async function wide(all) {
    openAll();
    await settled();
    const wrong = [];
    if (document.documentElement.scrollWidth > innerWidth) wrong.push(`the page is ${document.documentElement.scrollWidth} wide on ${innerWidth}`);
    for (const one of document.querySelectorAll(".scroll")) {
      const over = one.scrollWidth > one.clientWidth + 1, hint = one.previousElementSibling?.matches(".hint");
      if (over && all) wrong.push(`a table is ${one.scrollWidth} wide in ${one.clientWidth}: ${named(one)}`);
      if (over !== Boolean(hint) || over !== (one.tabIndex === 0)) wrong.push(`${over ? "no hint" : "a hint for nothing"} above ${named(one)}`);
    }
    return wrong;
  }

  // WCAG 2.2, contrast of text: relative luminances of the colour over what lies behind it.
  const channels = text => { const [r, g, b, a = 1] = text.match(/[\d.]+/g).map(Number); return { r, g, b, a }; };
  const over = (top, under) => { const mix = k => top[k] * top.a + under[k] * (1 - top.a); return { r: mix("r"), g: mix("g"), b: mix("b"), a: 1 }; };
  const luminance = c => { const f = v => (v /= 255) <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; return 0.2126 * f(c.r) + 0.7152 * f(c.g) + 0.0722 * f(c.b); };
  function behind(one) {
    const layers = [];
    for (let at = one; at; at = at.parentElement) layers.unshift(channels(getComputedStyle(at).backgroundColor));
    return layers.reduce((under, top) => over(top, under), { r: 255, g: 255, b: 255, a: 1 });
  }
  function contrast() {
    openAll();
    const wrong = new Map(), walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    let count = 0;
    while (walker.nextNode()) {
      const one = walker.currentNode.parentElement;
      if (!walker.currentNode.data.trim() || !shown(one) || one.closest("script, style")) continue;
      count++;
      const style = getComputedStyle(one), inPicture = one.closest("svg"), back = behind(one);
      const ink = channels(inPicture ? style.fill : style.color);
      for (let at = one; at; at = at.parentElement) ink.a *= Number(getComputedStyle(at).opacity);
      const [low, high] = [luminance(over(ink, back)), luminance(back)].sort((a, b) => a - b), ratio = (high + 0.05) / (low + 0.05);
      const large = parseFloat(style.fontSize) >= 24 || (parseFloat(style.fontSize) >= 18.66 && Number(style.fontWeight) >= 700);
      if (ratio < (large ? 3 : 4.5)) wrong.set(`${ratio.toFixed(2)} ${named(one)}`, true);
    }
    return count < 40 ? [`only ${count} texts seen`] : [...wrong.keys()];
  }

  function tables() {
    const wrong = [];
    for (const one of document.querySelectorAll("table")) {
      if (!one.caption || !one.caption.textContent.trim()) wrong.push(`no caption: ${named(one)}`);
      if (!one.querySelector("th")) wrong.push(`no heads: ${named(one)}`);
      for (const head of one.querySelectorAll("th")) if (!["col", "row"].includes(head.scope)) wrong.push(`no scope: ${named(head)}`);
    }
    return wrong;
  }

  // Words of each picture: within it, and none on another.
  function words() {
    const wrong = [];
    for (const svg of document.querySelectorAll(".plot > svg, .drawing > svg")) {
      if (!shown(svg)) continue;
      const room = svg.getBoundingClientRect(), seen = [...svg.querySelectorAll("text")].filter(shown).map(one => [named(one), one.getBoundingClientRect()]);
      const whose = svg.closest("figure")?.id || "drawing";
      if (!seen.length) wrong.push(`${whose}: no words`);
      seen.forEach(([name, box], i) => {
        if (box.left < room.left - 1 || box.right > room.right + 1 || box.top < room.top - 2 || box.bottom > room.bottom + 2) wrong.push(`${whose}: ${name} is cut`);
        for (const [other, its] of seen.slice(i + 1)) if (meet(box, its)) wrong.push(`${whose}: ${name} lies on ${other}`);
      });
    }
    return wrong;
  }

  const told = figure => { const tip = figure.querySelector(".tip"); return tip.hidden ? [] : [...tip.children].map(one => one.textContent); };

  function legends() {
    const wrong = [];
    for (const button of document.querySelectorAll(".keys button")) {
      const figure = button.closest("figure"), name = `${figure.id}: ${named(button)}`;
      const seen = () => [...figure.querySelectorAll(".plot svg g, .plot svg path, .plot svg circle, .plot svg rect")].filter(shown).length;
      const before = seen(), pressed = () => button.getAttribute("aria-pressed"), chart = charts.find(one => one.id === figure.id);
      const draws = chart.lines.some(line => line.group === button.dataset.group && line.x.length);
      button.click();
      if (pressed() !== "false" || (draws && seen() >= before)) wrong.push(`${name} hides nothing`);
      button.click();
      if (pressed() !== "true" || seen() !== before) wrong.push(`${name} does not come back`);
    }
    return wrong;
  }

  function frames() {
    const wrong = [], bars = [...document.querySelectorAll(".frames")];
    for (const bar of bars) {
      const figure = bar.closest("figure"), range = bar.querySelector("input"), svg = figure.querySelector("svg"), seen = new Set(), names = new Set();
      for (const at of [0, Math.floor(range.max / 3), Number(range.max)]) {
        range.value = at; range.dispatchEvent(new Event("input", { bubbles: true }));
        seen.add(svg.innerHTML); names.add(bar.querySelector("output").textContent);
      }
      if (bar.hidden || seen.size < 3 || names.size < 3) wrong.push(`${figure.id}: ${seen.size} pictures, ${names.size} names of frames`);
      const size = JSON.stringify(charts.find(one => one.id === figure.id)).length;
      if (size > 150000) wrong.push(`${figure.id} weighs ${size}`);
    }
    return wrong;
  }

  // Moving pictures that have begun by themselves once they are looked at.
  async function playing() {
    const going = [];
    for (const figure of document.querySelectorAll("figure")) {
      const button = figure.querySelector(".frames button");
      if (!button) continue;
      figure.scrollIntoView({ block: "center", behavior: "instant" });
      await new Promise(done => setTimeout(done, 150));
      if (button.textContent !== "Play") going.push(figure.id);
    }
    return going;
  }

  // As printed: nothing broader than its place on the paper.
  function paper(landscape) {
    const wrong = [];
    for (const one of document.querySelectorAll(".scroll, .inputs, figure, .drawing, pre, dl")) {
      if (!shown(one) || Boolean(one.closest(".landscape")) !== landscape) continue;
      const inner = Math.max(one.scrollWidth, ...[...one.querySelectorAll("table, svg")].map(part => part.getBoundingClientRect().width));
      if (inner > one.clientWidth + 1) wrong.push(`${Math.round(inner)} in ${one.clientWidth}: ${named(one)}`);
    }
    return wrong;
  }

  const printed = () => ({
    charts: [...document.querySelectorAll("figure")].map(one => [one.querySelector("h3").firstChild.data, one.querySelector("figcaption").textContent, charts.find(c => c.id === one.id).xtitle]),
    cells: [...document.querySelectorAll("td, dd")].filter(one => shown(one) && one.textContent.trim().length > 40).map(one => one.textContent),
  });

  const pictures = () => [...document.querySelectorAll("svg.drawn")].filter(one => one.getBoundingClientRect().width > 200).length;
  return { wide, contrast, tables, words, told, legends, frames, playing, paper, printed, pictures, close };
})();

// The queries of check_page.py, evaluated in the page; every function returns plain values.
(() => {
  const text = (node) => node.textContent.trim().replace(/\s+/g, " ");

  // Charts whose marks, or whose letters, lie beyond their drawing; and those without marks or words.
  const charts = () => [...document.querySelectorAll("figure svg")].map((svg) => {
    const frame = svg.getBoundingClientRect(), faults = [];
    const inside = (node) => {
      const box = node.getBoundingClientRect(), slack = 1;
      return box.left >= frame.left - slack && box.right <= frame.right + slack && box.top >= frame.top - slack &&
             box.bottom <= frame.bottom + slack;
    };
    const marks = [...svg.querySelectorAll(".mark, .bar")];
    for (const mark of marks) {
      if (!inside(mark)) faults.push("mark outside: " + text(mark));
      const box = mark.getBBox();
      if (!(box.width > 0) || !(box.height > 0)) faults.push("mark without size: " + text(mark));
      if (text(mark) === "") faults.push("mark without hover text");
    }
    for (const label of svg.querySelectorAll("text")) if (!inside(label)) faults.push("text outside: " + text(label));
    const words = (svg.getAttribute("aria-labelledby") || "").split(" ").map((id) => document.getElementById(id));
    if (svg.getAttribute("role") !== "img" || words.length !== 2 || words.some((node) => !node || text(node) === ""))
      faults.push("no text alternative");
    return {title: words[0] ? text(words[0]) : "", marks: marks.length, hovers: marks.map(text), faults};
  });

  const tables = () => [...document.querySelectorAll("table")].map((table) => {
    let group = "";
    const rows = [];
    for (const row of table.querySelectorAll("tbody tr")) {
      const cells = [...row.querySelectorAll("td")];
      const head = text(row.querySelector("th"));
      if (cells.length === 0) { group = head; continue; }
      rows.push({group, head, cells: cells.map((cell) => ({text: text(cell),
        values: [...cell.querySelectorAll("data")].map((data) => Number(data.value.replace("inf", "Infinity"))),
        shown: [...cell.querySelectorAll("data")].map(text)}))});
    }
    const heads = [...table.querySelectorAll("thead th")];
    return {caption: text(table.caption), heads: heads.map(text), rows,
            scoped: [...table.querySelectorAll("th")].every((head) => head.scope !== "")};
  });

  // Texts of less contrast than 4.5 : 1 to what is behind them, with their colours [WCAG 2.1, 1.4.3].
  const rgb = (colour) => colour.match(/[\d.]+/g).map(Number);
  const luminance = (colour) => {
    const linear = (c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    const [r, g, b] = rgb(colour).map((c) => linear(c / 255));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const behind = (node) => {
    for (; node; node = node.parentElement) {
      const colour = getComputedStyle(node).backgroundColor;
      if (rgb(colour)[3] !== 0) return colour;
    }
    return "rgb(255, 255, 255)";
  };
  const pale = () => {
    const found = new Set();
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const node = walker.currentNode.parentElement;
      if (walker.currentNode.data.trim() === "" || ["title", "desc", "STYLE"].includes(node.tagName)) continue;
      const style = getComputedStyle(node), back = behind(node);
      const front = node.ownerSVGElement ? style.fill : style.color;
      const [a, b] = [luminance(front), luminance(back)].sort((x, y) => y - x);
      if ((a + 0.05) / (b + 0.05) < 4.5) found.add(`${front} on ${back}: ${node.className.baseVal ?? node.className}`);
    }
    return [...found];
  };

  // Colours of marks against the paper: 3 : 1 [WCAG 2.1, 1.4.11].
  const paleMarks = () => [...new Set([...document.querySelectorAll(
    ".mark, .line, .whisker, .published, .median")].map((mark) => {
    const style = getComputedStyle(mark),
          front = mark.matches(".mark:not(.hollow)") ? style.fill : style.stroke;
    const [a, b] = [luminance(front), luminance(behind(mark))].sort((x, y) => y - x);
    return (a + 0.05) / (b + 0.05) < 3 ? mark.getAttribute("class") + " " + front : "";
  }))].filter((text) => text !== "");

  return {
    charts, tables, pale, paleMarks,
    overflow: (width) => document.documentElement.scrollWidth - width,
    verdicts: () => [...document.querySelectorAll(".verdicts li")].map((line) => ({
      arm: text(line.querySelector(".arm")), verdict: line.querySelector(".badge").classList[1],
      why: text(line.querySelector(".why")),
      values: [...line.querySelectorAll("data")].map((data) => Number(data.value))})),
    heads: () => [...document.querySelectorAll("h1, h2, h3, h4")].map((head) => [Number(head.tagName[1]), text(head)]),
    active: () => [...document.querySelectorAll(
      "script, [onload], [onclick], [onerror], iframe, object, embed, link[rel=stylesheet]")]
      .map((node) => node.outerHTML),
    addresses: () => [...document.querySelectorAll("[src], [href]")].map((node) =>
      node.getAttribute("src") ?? node.getAttribute("href")),
    repeated: () => { const ids = [...document.querySelectorAll("[id]")].map((node) => node.id);
      return ids.filter((id, i) => ids.indexOf(id) !== i); },
    words: () => document.body.innerText,
  };
})()

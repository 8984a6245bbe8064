// The page works without this: plots and table are there already. It ties together what belongs to one point, tells of
// it where the pointer is, sorts the table, and hands out the plots as files.
"use strict";
(() => {
  const tip = document.getElementById("tip");
  const all = (what) => Array.from(document.querySelectorAll(what));
  let pinned = null;

  const light = (point) => {
    for (const e of all("[data-point]")) e.classList.toggle("lit", point !== null && e.dataset.point === point);
    document.body.classList.toggle("hovering", point !== null);
  };
  const words = (element) => {
    const title = element.querySelector("title");
    return title ? title.textContent : element.dataset.text || "";
  };
  const show = (element, x, y) => {
    tip.textContent = words(element);
    tip.hidden = tip.textContent === "";
    const box = tip.getBoundingClientRect();
    tip.style.left = Math.max(8, Math.min(x + 14, innerWidth - box.width - 8)) + "px";
    tip.style.top = (y + 18 + box.height > innerHeight ? Math.max(8, y - box.height - 12) : y + 18) + "px";
  };

  for (const element of all("[data-point]")) {
    const point = element.dataset.point;
    // Browsers would show the title a second time, in a box of their own.
    const title = element.querySelector("title");
    if (title) {
      element.dataset.text = title.textContent;
      element.setAttribute("aria-label", title.textContent);
      title.remove();
    }
    element.addEventListener("pointerenter", (event) => {
      if (pinned === null) light(point);
      show(element, event.clientX, event.clientY);
    });
    element.addEventListener("pointermove", (event) => show(element, event.clientX, event.clientY));
    element.addEventListener("pointerleave", () => {
      tip.hidden = true;
      if (pinned === null) light(null);
    });
    element.addEventListener("click", (event) => {
      pinned = pinned === point ? null : point;
      light(pinned);
      event.stopPropagation();
    });
  }
  document.addEventListener("click", () => {
    pinned = null;
    light(null);
  });

  // Numbers by size, words by letters; what is not there comes last either way.
  const key = (row, column) => {
    const text = row.cells[column].dataset.sort;
    return text === "" || isNaN(text) ? text : Number(text);
  };
  for (const head of all("thead th[aria-sort]")) {
    head.querySelector("button").addEventListener("click", () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      for (const other of all("thead th[aria-sort]")) other.setAttribute("aria-sort", "none");
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const body = head.closest("table").tBodies[0];
      const column = head.cellIndex;
      const rows = Array.from(body.rows).sort((a, b) => {
        const p = key(a, column), q = key(b, column);
        if (p === "" || q === "") return (p === "") - (q === "");
        const order = typeof p === "number" && typeof q === "number" ? p - q : String(p).localeCompare(String(q));
        return up ? order : -order;
      });
      body.append(...rows);
    });
  }

  const hand_out = (text, type, name) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  };
  for (const button of all("figure button")) {
    button.hidden = false;
    button.addEventListener("click", (event) => {
      event.stopPropagation();
      const picture = button.closest("figure").querySelector("svg").cloneNode(true);
      for (const e of picture.querySelectorAll(".lit")) e.classList.remove("lit");
      hand_out(new XMLSerializer().serializeToString(picture), "image/svg+xml", picture.dataset.name + ".svg");
    });
  }
  const data = document.getElementById("study-data");
  const save = document.getElementById("save-data");
  save.hidden = false;
  save.addEventListener("click", () => hand_out(data.textContent, "application/json", "study.json"));
})();

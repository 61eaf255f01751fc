// Runs inside the page: creates components and edits every member of them as people do, by the page's own controls.
globalThis.driver = (() => {
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  /** What is bound to come is waited for, however busy the machine is. */
  const patience = 120000;
  const until = async (test, ms = patience) => {
    for (const end = performance.now() + ms; performance.now() < end; await pause(8)) {
      const value = test();
      if (value) return value;
    }
    return null;
  };
  const set = (element, value) => {
    const kind = element instanceof HTMLTextAreaElement ? HTMLTextAreaElement : element instanceof HTMLSelectElement ? HTMLSelectElement : HTMLInputElement;
    Object.getOwnPropertyDescriptor(kind.prototype, "value").set.call(element, value);
    element.dispatchEvent(new Event("input", { bubbles: true }));
  };
  const key = (element, name, more = {}) => element.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true, ...more }));
  const component = (id) => studio.state.components.get(id);
  const fieldOf = (id, member) => document.getElementById(`field-${id}-${member}`)?.closest(".field");
  const selectedId = () => Number(document.querySelector(".panel")?.dataset.component ?? 0);

  /** Clicks the row of what is called `name`. */
  async function select(name) {
    const find = () => [...document.querySelectorAll("[role=treeitem]")].find((r) => r.querySelector(".what")?.textContent === name);
    const row = await until(() => {
      const found = find();
      if (!found) document.querySelectorAll("[role=treeitem][aria-expanded=false] .twist").forEach((twist) => twist.click());
      return found;
    });
    if (!row) throw new Error(`no row ${name}`);
    row.click();
    if (!(await until(() => document.querySelector(".panel-title h2")?.textContent === name))) throw new Error(`no panel of ${name}`);
  }

  /** Chooses a class in the window that is open; gives the identifier of what was made. */
  async function choose(name) {
    const input = await until(() => document.querySelector("dialog.chooser input[role=combobox]"));
    if (!input) throw new Error("no window of classes");
    if (name) {
      set(input, name);
      if (!(await until(() => document.querySelector("[role=option][aria-selected=true] b")?.textContent === name))) throw new Error(`${name} is not offered`);
    }
    const chosen = document.querySelector("[role=option][aria-selected=true] b")?.textContent;
    const before = selectedId();
    const told = () => document.querySelector(".notice-error span")?.textContent;
    document.querySelectorAll(".notice button").forEach((b) => b.click());
    await until(() => !told());
    key(input, "Enter");
    await until(() => !document.querySelector("dialog.chooser"));
    const made = await until(() => {
      const files = document.querySelector("dialog.browser"); // it needs a file, which there is not
      if (files) [...files.querySelectorAll("button")].find((b) => b.textContent === "Cancel")?.click();
      if (told()) return -1;
      return selectedId() !== before && document.querySelector(".panel-title")?.textContent?.includes(chosen) && selectedId();
    });
    if (made === -1) throw new Error(`refused: ${told()}`);
    return made || 0;
  }

  /** Puts a component of a class into a member of what is selected. */
  async function create(member, name) {
    const id = selectedId();
    const field = await until(() => fieldOf(id, member));
    if (!field) throw new Error(`no field ${member}`);
    const buttons = [...field.querySelectorAll(".control button")];
    const button = buttons.find((b) => /^(Add|Change the class|Use a map)/.test(b.getAttribute("aria-label") ?? b.textContent ?? ""));
    if (!button) throw new Error(`no button at ${member}`);
    const before = signature(id, member);
    button.click();
    const opened = await until(() => document.querySelector("dialog.chooser") || selectedId() !== id || signature(id, member) !== before);
    if (opened instanceof HTMLElement) return choose(name);
    // There is but one class: it was added at once.
    return (await until(() => component(id)?.members[member]?.value?.component)) ?? 0;
  }

  const signature = (id, member) => {
    const m = component(id)?.members[member];
    return m ? JSON.stringify([m.text, m.value, m.written]) : "";
  };
  const complaint = (id, member) => fieldOf(id, member)?.querySelector("[role=alert]")?.textContent ?? "";

  /** Once the program has answered all edits. That one is on its way is shown when the page is drawn next, not at once. */
  async function idle() {
    await pause(8);
    await until(() => document.querySelector(".panel")?.getAttribute("aria-busy") !== "true");
  }

  /** What became of an edit, once it is answered: null if it neither changed anything nor was refused. */
  async function settled(id, member, before) {
    await idle();
    await studio.ask("watch", { what: "none" }); // whatever the edit has changed was told before this is answered
    return signature(id, member) !== before ? "changed" : complaint(id, member) ? "refused" : null;
  }

  /** Takes away what was said of an earlier try, so that what is said next is seen. */
  async function forget(id, member, element) {
    if (!complaint(id, member)) return;
    key(element, "Escape");
    await until(() => !complaint(id, member));
  }

  /** Tries texts in an entry until one is taken. */
  async function tryTexts(id, member, index, texts) {
    let refused = "";
    for (const text of texts) {
      const before = signature(id, member);
      const entry = fieldOf(id, member)?.querySelectorAll(".entry")[index];
      if (!entry) return "no entry";
      if (entry.value === text) continue;
      entry.focus();
      await forget(id, member, entry);
      set(entry, text);
      key(entry, "Enter", { ctrlKey: true });
      const end = await settled(id, member, before);
      entry.blur(); // which tries what was refused once more
      await idle();
      if (end === "changed") return "changed";
      refused = complaint(id, member) || refused;
      key(entry, "Escape");
    }
    return refused ? `refused: ${refused}` : "silent";
  }

  function numbers(m) {
    const { low = -Infinity, high = Infinity, more_than = -Infinity } = m.range ?? {};
    const d = typeof m.default === "number" ? m.default : 0;
    const inside = (v) => v >= low && v <= high && v > more_than && v !== d;
    const s = m.slider ?? [0, 1];
    const all = [d + 1, d * 0.5, d * 0.9, d + 2, (s[0] + s[1]) / 2, s[0] + 0.3 * (s[1] - s[0]), 1, 2, 3, 4, 0.5, 0].map((v) => (m.type === "integer" ? Math.round(v) : Number(v.toPrecision(4))));
    return [...new Set(all.filter(inside))].map(String);
  }

  async function edit(id, m) {
    const field = await until(() => fieldOf(id, m.name));
    if (!field) return "no field";
    const before = signature(id, m.name);
    const said = () => (complaint(id, m.name) ? `refused: ${complaint(id, m.name)}` : "silent");
    const click = async (element) => {
      element.click();
      return (await settled(id, m.name, before)) === "changed" ? "changed" : said();
    };
    if (m.type === "component") {
      const literal = field.querySelector(".reference.literal .entry");
      if (literal) return tryTexts(id, m.name, 0, ["0.25", "0.5", "0.125"]);
      const now = field.querySelector(".go .class, .go .what")?.textContent;
      const other = m.offered.find((c) => c !== now && !m.list) ?? m.offered[0];
      try {
        const made = await create(m.name, m.offered.length > 1 || field.querySelector(".go") || m.list ? other : undefined);
        await until(() => signature(id, m.name) !== before, m.offered.length < 2 ? 1500 : patience); // the only one there is may be there already
        if (made && selectedId() !== id) {
          const back = [...document.querySelectorAll(".panel-head nav .link")].pop();
          back?.click();
          await until(() => selectedId() === id);
        }
        return signature(id, m.name) !== before ? "changed" : m.offered.length < 2 ? "alone" : "silent";
      } catch (error) {
        document.querySelector("dialog button[aria-label=Close]")?.click();
        document.querySelectorAll(".notice button").forEach((b) => b.click());
        return String(error.message);
      }
    }
    if (m.type === "boolean") return click(field.querySelector("input"));
    if (m.choices && m.list) return click(field.querySelector("input[type=checkbox]"));
    if (m.choices) {
      const list = field.querySelector("select");
      for (const option of [...list.options].map((o) => o.value).filter((v) => v !== list.value)) {
        await forget(id, m.name, list);
        set(list, option);
        list.dispatchEvent(new Event("change", { bubbles: true }));
        if ((await settled(id, m.name, before)) === "changed") return "changed";
      }
      return list.options.length < 2 ? "alone" : said();
    }
    if (m.type === "transform") {
      const move = [...field.querySelectorAll("button")].find((b) => b.textContent?.includes("Move"));
      if (!move) return tryTexts(id, m.name, 0, ["translate(0, 0.25, 0)"]);
      return click(move);
    }
    if (m.type === "file") {
      if (!m.list) return tryTexts(id, m.name, 0, ["data/cornell_white.csv"]);
      return field.querySelector("button") ? "files" : "no button";
    }
    if (m.type === "color") return tryTexts(id, m.name, 0, ["0.25", "1.25", 'complex(0.5, 3)', "rgb(0.25, 0.5, 0.75)"]);
    if (m.type === "string") return tryTexts(id, m.name, 0, ["x", "x*x + y*y + z*z - 2", "a"]);
    const now = field.querySelector(".entry")?.value ?? "";
    if (m.list) {
      const more = now.trim() === "[]" ? ["[1, 2]", "[1]", "[[0, 0, 1]]", "[[0, 1]]", "[0, 0, 4, 4]"] : [now.replace(/-?\d+(\.\d+)?(?=[^\d]*$)/, (n) => String(Number(n) + 0.25)), now.replace(/\]\s*$/, ", 1]")];
      return tryTexts(id, m.name, 0, more);
    }
    if (m.type === "number" || m.type === "integer") return tryTexts(id, m.name, 0, numbers(m));
    return tryTexts(id, m.name, 0, ["0.25", "0.5", "2", "1", "-1"]);
  }

  /** Brings a member back to its default by the button behind it. */
  async function reset(id, member) {
    const before = signature(id, member);
    const button = fieldOf(id, member)?.querySelector(".after button");
    if (!button) return "no button";
    button.click();
    return (await settled(id, member, before)) ?? "silent";
  }

  /** Selects a component that the present panel refers to. */
  async function go(id) {
    const [holder] = component(id)?.uses ?? [];
    fieldOf(holder?.id, holder?.member)?.querySelector(".go")?.click();
    await until(() => selectedId() === id);
  }

  return { select, create, edit, reset, go, selectedId };
})();

// The page: the tree on the left, picture, text or paths in the middle, the panel on the right, the render below.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { ControlStrip } from "./control/control.tsx";
import { FileBrowser } from "./files/browser.tsx";
import { Help } from "./help.tsx";
import { remember, remembered } from "./model/memory.ts";
import { dismiss, document_, line, notices, tab, viewing, type Tab } from "./model/state.ts";
import { Explanation } from "./panel/explanation.tsx";
import { Panel } from "./panel/panel.tsx";
import { Button, Divider, Tabs } from "./parts/parts.tsx";
import { Paths } from "./paths/paths.tsx";
import { Picture } from "./picture/picture.tsx";
import { SavePicture, savePicture } from "./picture/save.tsx";
import { PictureToolbar } from "./picture/toolbar.tsx";
import { Sides } from "./sides/sides.tsx";
import { Strategies } from "./sides/strategies.tsx";
import { Editor } from "./text/editor.tsx";
import { texts } from "./texts/texts.ts";
import { TopBar } from "./top_bar.tsx";
import { Chooser, Renaming, Sharing } from "./tree/chooser.tsx";
import { Tree } from "./tree/tree.tsx";

const left = signal(remembered("left", window.innerWidth < 1250 ? 216 : 270));
const right = signal(remembered("right", window.innerWidth < 1250 ? 296 : 350));

function resize(which: "left" | "right") {
  return (size: number): void => {
    (which === "left" ? left : right).value = size;
    remember(which, size);
  };
}

export function App(): JSX.Element {
  const chosen = tab.value;
  if (viewing.value) return <Viewing />;
  const tabs: { name: Tab; label: string }[] = [
    { name: "picture", label: texts.tabs.picture },
    { name: "text", label: texts.tabs.text },
    { name: "paths", label: texts.tabs.paths },
    { name: "sides", label: texts.tabs.sides },
  ];
  return (
    <div class="app" style={{ gridTemplateColumns: `${left.value}px minmax(0, 1fr) ${right.value}px` }}>
      <TopBar />
      {document_.value?.changed_on_disk && <p class="banner" role="status">{texts.top.changedElsewhere}</p>}
      <aside class="left" aria-label={texts.tree.label}>
        <Tree />
        <Divider label={texts.common.divider} size={left.value} least={180} most={460} change={resize("left")} />
      </aside>
      <main class="middle">
        <Tabs label={texts.tabs.label} tabs={tabs} chosen={chosen} choose={(name) => (tab.value = name)} />
        <div class="tab-panel" id="panel-picture" role="tabpanel" aria-labelledby="tab-picture" hidden={chosen !== "picture"}>
          <PictureToolbar />
          <Picture />
        </div>
        <div class="tab-panel" id="panel-text" role="tabpanel" aria-labelledby="tab-text" hidden={chosen !== "text"}>
          <Editor />
        </div>
        <div class="tab-panel" id="panel-paths" role="tabpanel" aria-labelledby="tab-paths" hidden={chosen !== "paths"}>
          {chosen === "paths" && <Paths />}
        </div>
        <div class="tab-panel" id="panel-sides" role="tabpanel" aria-labelledby="tab-sides" hidden={chosen !== "sides"}>
          {chosen === "sides" && <Sides />}
        </div>
        <ControlStrip />
      </main>
      <aside class="right" aria-label={texts.panel.label}>
        <Divider label={texts.common.divider} size={right.value} least={270} most={620} after change={resize("right")} />
        <div class="panel-side">
          <Panel />
          <Explanation />
        </div>
      </aside>
      <Notices />
      <Chooser />
      <Renaming />
      <Sharing />
      <FileBrowser />
      {savePicture.value && <SavePicture />}
      <Strategies />
      <Help />
      {line.value === "closed" && <p class="banner ended" role="alert">{texts.top.locked.closed}</p>}
    </div>
  );
}

/** Pictures without a document: `etendue view`. */
function Viewing(): JSX.Element {
  return (
    <div class="app viewing">
      <main class="middle" aria-label={texts.viewing.title}>
        <h1 class="unseen">{texts.viewing.title}</h1>
        <PictureToolbar />
        <Picture />
      </main>
      <Notices />
      <Help />
    </div>
  );
}

function Notices(): JSX.Element {
  return (
    <div class="notices" role="log" aria-live="polite" aria-label={texts.notices.label}>
      {notices.value.map((n) => (
        <div key={n.key} class={`notice notice-${n.kind}`}>
          <span>{n.text}</span>
          <Button icon="close" label={texts.common.close} onClick={() => dismiss(n.key)} />
        </div>
      ))}
    </div>
  );
}

// Saves the picture: as the program writes it (PNG, EXR, …) beside the scene, or what is seen, as a download.
import { signal, useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { document_, folders, notify } from "../model/state.ts";
import { demand } from "../model/studio.ts";
import { Refused } from "../model/protocol.ts";
import { Button, Dialog } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { takeScreenshot } from "./canvas.ts";
import { factors, relighting } from "./lights.ts";

export const savePicture = signal(false);
const t = texts.picture;

export function SavePicture(): JSX.Element | null {
  const base = (document_.value?.file ?? `${folders.value[0] ?? "."}/picture.etd`).replace(/\.(etd|json)$/, "");
  const file = useSignal(`${base}.png`);
  const exists = useSignal(false);
  const wrong = useSignal("");
  const close = (): void => {
    savePicture.value = false;
  };
  const save = async (over: boolean): Promise<void> => {
    wrong.value = "";
    try {
      await demand("save_picture", { file: file.value, over, ...(relighting.value ? { lights: factors.value } : {}) });
      notify(t.saved(file.value));
      close();
    } catch (error) {
      exists.value = error instanceof Refused && error.code === "changed_on_disk";
      wrong.value = exists.value ? t.exists : error instanceof Error ? error.message : String(error);
    }
  };
  const download = async (): Promise<void> => {
    const blob = await takeScreenshot?.();
    if (!blob) return;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `${(document_.value?.title ?? "picture").replace(/\.(etd|json)$/, "")}.png`;
    link.click();
    URL.revokeObjectURL(link.href);
  };
  return (
    <Dialog title={t.save} close={close}>
      <form
        onSubmit={(e) => {
          e.preventDefault();
          void save(false);
        }}
      >
        <label class="stack">
          <span>{t.saveFile}</span>
          <input type="text" value={file.value} spellcheck={false} onInput={(e) => (file.value = e.currentTarget.value)} />
        </label>
        <p class="dim">{t.saveHelp}{relighting.value && ` ${texts.lights.saved}`}</p>
        {wrong.value && <p class="wrong" role="alert">{wrong.value}</p>}
        <footer>
          <Button label={t.download} onClick={() => void download()} />
          {exists.value && <Button label={texts.files.over} onClick={() => void save(true)} />}
          <button type="submit" class="button primary">{texts.common.save}</button>
        </footer>
      </form>
    </Dialog>
  );
}

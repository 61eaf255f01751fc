// The pictures of `etendue view`: one of them is shown. Numbers go from one to the next: Page Up and Page Down as well.
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { pictures } from "../model/state.ts";
import { pictureLayer, watch } from "../model/studio.ts";
import { texts } from "../texts/texts.ts";
import { chosenPicture, watchedPicture } from "./probe.ts";

function show(name: string | undefined): void {
  if (name === undefined) return;
  chosenPicture.value = name;
  watch({ what: "linear", layer: pictureLayer(name) });
}

export function ViewedPictures(): JSX.Element {
  useEffect(() => {
    const key = (event: KeyboardEvent): void => {
      const by = event.key === "PageDown" ? 1 : event.key === "PageUp" ? -1 : 0;
      const at = pictures.value.findIndex((p) => p.name === watchedPicture.value);
      if (!by || at < 0) return;
      event.preventDefault();
      show(pictures.value[(at + by + pictures.value.length) % pictures.value.length]?.name);
    };
    document.addEventListener("keydown", key);
    return () => document.removeEventListener("keydown", key);
  }, []);
  return (
    <select aria-label={texts.viewing.pictures} title={texts.viewing.pictures} value={watchedPicture.value ?? ""} onChange={(e) => show(e.currentTarget.value)}>
      {pictures.value.map((p) => <option key={p.name}>{p.name}</option>)}
    </select>
  );
}

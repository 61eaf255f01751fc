// Requests that would lose something: refused at first, and made once somebody has said that it may be lost.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { Refused } from "../model/protocol.ts";
import { ask, demand, report } from "../model/studio.ts";
import { Button, Dialog } from "./parts.tsx";
import { texts } from "../texts/texts.ts";

const t = texts.top;
/** What is to be done once it is clear that unsaved changes may be lost. */
const asking = signal<{ text: string; yes: string; then: () => Promise<void> } | null>(null);

/** Whether it was done at once. If it is refused with `code`, `text` asks whether to do it `again` with more arguments. */
export async function guarded(what: string, arguments_: Record<string, unknown>, again: Record<string, unknown>, code: string, text: string, yes: string): Promise<boolean> {
  try {
    await demand(what, arguments_);
    return true;
  } catch (error) {
    if (error instanceof Refused && error.code === code) {
      asking.value = { text, yes, then: async () => void (await ask(what, { ...arguments_, ...again })) };
    } else report(error);
    return false;
  }
}

export function Question(): JSX.Element | null {
  const what = asking.value;
  if (!what) return null;
  const close = (): void => {
    asking.value = null;
  };
  return (
    <Dialog title={t.sure} close={close}>
      <p>{what.text}</p>
      <footer>
        <Button label={texts.common.cancel} onClick={close} />
        <Button primary label={what.yes} onClick={() => (close(), void what.then())} />
      </footer>
    </Dialog>
  );
}

// Names of files, and a browser of the folders that are allowed.
import type { JSX } from "preact";
import { quote } from "../model/expressions.ts";
import { Button } from "../parts/parts.tsx";
import { texts } from "../texts/texts.ts";
import { chooseFile, relative } from "../files/browser.tsx";
import { setMember } from "./edit.ts";
import { Entry } from "./entry.tsx";
import type { FieldProps } from "./field_props.ts";

export function FileField({ component, member, state, id }: FieldProps): JSX.Element {
  const text = typeof state.value === "string" ? state.value : "";
  const browse = async (): Promise<void> => {
    const file = await chooseFile({ title: texts.files.choose(member.name) });
    if (file !== null) await setMember(component.id, member.name, quote(relative(file)));
  };
  return (
    <div class="file">
      <Entry id={id} text={text} label={member.name} placeholder={texts.files.none} commit={(now) => setMember(component.id, member.name, quote(now))} />
      <Button icon="folder" label={texts.files.browse} onClick={() => void browse()} />
    </div>
  );
}

export function FileList({ component, member, state, id }: FieldProps): JSX.Element {
  const files = Array.isArray(state.value) ? state.value.map(String) : [];
  const set = (next: string[]): Promise<boolean> => setMember(component.id, member.name, `[${next.map(quote).join(", ")}]`);
  const browse = async (): Promise<void> => {
    const file = await chooseFile({ title: texts.files.choose(member.name) });
    if (file !== null) await set([...files, relative(file)]);
  };
  return (
    <div class="list" id={id} role="group" aria-label={member.name}>
      {files.map((file, i) => (
        <div class="file" key={i}>
          <Entry label={`${member.name} ${i + 1}`} text={file} commit={(now) => set(files.map((f, j) => (j === i ? now : f)))} />
          <Button icon="close" label={texts.panel.removeFrom(i + 1)} onClick={() => void set(files.filter((_, j) => j !== i))} />
        </div>
      ))}
      <Button icon="folder" text label={texts.files.browse} onClick={() => void browse()} />
    </div>
  );
}

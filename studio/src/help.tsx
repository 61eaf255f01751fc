// Keys, the version, and the licences of what the page is made with.
import type { JSX } from "preact";
import { version } from "./model/state.ts";
import { Dialog } from "./parts/parts.tsx";
import { helping } from "./top_bar.tsx";
import { texts } from "./texts/texts.ts";

const t = texts.help;

export function Help(): JSX.Element | null {
  if (!helping.value) return null;
  const licences = document.querySelector<HTMLTemplateElement>("template#licences")?.content.textContent ?? "";
  return (
    <Dialog title={t.title} close={() => (helping.value = false)} class="help-window">
      <div class="scroll" tabIndex={0} role="region" aria-label={t.title}>
        {t.groups.map((g) => (
          <section key={g.name}>
            <h3>{g.name}</h3>
            <dl class="keys">
              {g.keys.map(([keys, what]) => (
                <div key={keys}>
                  <dt><kbd>{keys}</kbd></dt>
                  <dd>{what}</dd>
                </div>
              ))}
            </dl>
          </section>
        ))}
        <p class="dim">{t.version(version.value)}</p>
        <details>
          <summary>{t.licences}</summary>
          <pre class="licences" tabIndex={0}>{licences}</pre>
        </details>
      </div>
    </Dialog>
  );
}

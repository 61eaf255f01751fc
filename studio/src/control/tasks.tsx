// Checks in processes of their own: conformance of a class, whether all algorithms agree, strategies apart; and beginning again with new plugins.
import type { JSX } from "preact";
import { guarded } from "../parts/guarded.tsx";
import { percent } from "../model/numbers.ts";
import type { Task } from "../model/protocol.ts";
import { readOnly, root, tasks } from "../model/state.ts";
import { ask } from "../model/studio.ts";
import { Button } from "../parts/parts.tsx";
import { shownStrategies } from "../sides/strategies.tsx";
import { texts } from "../texts/texts.ts";

const t = texts.tasks;

export function TasksView(): JSX.Element {
  const off = readOnly.value || root.value === null;
  return (
    <div class="tasks">
      <h2 class="small">{t.title}</h2>
      <ul class="plain scroll">
        {[...tasks.value].reverse().map((task) => <li key={task.task}><TaskView task={task} /></li>)}
        {tasks.value.length === 0 && <li class="dim">{t.none}</li>}
      </ul>
      <div class="cluster wrap">
        <Button label={t.verify} hint={t.verifyHelp} disabled={off} onClick={() => void ask("verify")} />
        <Button label={t.strategies} hint={t.strategiesHelp} disabled={off} onClick={() => void ask("strategies")} />
        <Button label={t.again} hint={t.againHelp} disabled={readOnly.value} onClick={() => void guarded("begin_again", {}, { discard: true }, "", "", "")} />
      </div>
    </div>
  );
}

function TaskView({ task }: { task: Task }): JSX.Element {
  const running = task.state === "running";
  const title = task.title ?? "";
  const verdict = task.passed === undefined ? t.states[task.state] : task.passed ? t.passed : t.notPassed;
  return (
    <details class={`task task-${task.state}${task.passed === false ? " task-wrong" : ""}`}>
      <summary>
        <b>{title}</b> <span class="dim">{running && task.fraction ? percent(task.fraction) : verdict}</span>
      </summary>
      <pre tabIndex={0}>{task.text}</pre>
      {running && <Button icon="stop" text label={t.end(title)} onClick={() => void ask("end_task", { task: task.task })} />}
      {task.strategies && <Button label={t.show} onClick={() => (shownStrategies.value = task)} />}
    </details>
  );
}

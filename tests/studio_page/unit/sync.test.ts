import assert from "node:assert/strict";
import { test } from "node:test";
import { ChangeSet, Text } from "@codemirror/state";
import { Sync, type Answer } from "../../../studio/src/text/sync.ts";

interface Change {
  begin: number;
  end: number;
  insert: string;
}

/** A program that keeps a text, and editors that change it at random, with messages that wait. */
class Program {
  text = "0123456789";
  revision = 1;
  readonly editors: Editor[] = [];

  take(changes: Change[], revision: number, by: Editor): Answer {
    if (revision !== this.revision) return { stale: true };
    for (const c of [...changes].sort((a, b) => b.begin - a.begin)) this.text = this.text.slice(0, c.begin) + c.insert + this.text.slice(c.end);
    ++this.revision;
    for (const e of this.editors) e.inbox.push({ revision: this.revision, changes, own: e === by });
    return { revision: this.revision, valid: true };
  }
}

class Editor {
  doc: Text;
  inbox: { revision: number; changes: Change[]; own: boolean }[] = [];
  outbox: (() => void)[] = [];
  sync: Sync;

  constructor(private readonly program: Program) {
    this.doc = Text.of([program.text]);
    this.sync = new Sync(this.doc, program.revision, {
      send: (revision, changes) =>
        new Promise((done) => this.outbox.push(() => {
          const answer = program.take(changes, revision, this);
          this.deliver(); // replies and events come in order: what happened before the answer is known with it
          done(answer);
        })),
      apply: (changes) => (this.doc = changes.apply(this.doc)),
    }, 1e6);
    program.editors.push(this);
  }

  type(from: number, to: number, insert: string): void {
    const changes = ChangeSet.of({ from, to, insert }, this.doc.length);
    this.doc = changes.apply(this.doc);
    this.sync.typed(changes);
  }

  deliver(): void {
    for (const { own, ...event } of this.inbox.splice(0)) this.sync.changed({ ...event, by: 1 }, own);
  }
}

function random(seed: number): (n: number) => number {
  let state = seed >>> 0; // the minimal standard generator of Park and Miller
  return (n) => {
    state = (state * 48271 + 1) % 2147483647;
    return state % n;
  };
}

test("editors that type at once end with the same text as the program", async () => {
  for (let seed = 1; seed <= 60; ++seed) {
    const next = random(seed);
    const program = new Program();
    const editors = [new Editor(program), new Editor(program)];
    for (let step = 0; step < 60; ++step) {
      const editor = editors[next(2)] as Editor;
      switch (next(4)) {
        case 0:
        case 1: {
          const from = next(editor.doc.length + 1);
          editor.type(from, Math.min(editor.doc.length, from + next(3)), "abc".slice(0, next(4)));
          break;
        }
        case 2:
          void editor.sync.flush();
          break;
        case 3:
          if (next(2)) editor.deliver();
          else editor.outbox.shift()?.();
      }
      await new Promise((r) => setImmediate(r));
    }
    for (let i = 0; i < 40; ++i) {
      for (const e of editors) {
        e.deliver();
        void e.sync.flush();
        e.outbox.shift()?.();
        await new Promise((r) => setImmediate(r));
      }
    }
    for (const e of editors) {
      e.deliver();
      assert.ok(e.sync.isClean, `seed ${seed}`);
      assert.equal(e.doc.toString(), program.text, `seed ${seed}`);
      e.sync.stop();
    }
  }
});

test("what is not valid stays in the editor and is sent again with what is typed next", async () => {
  const sent: Change[][] = [];
  let valid = false;
  const sync = new Sync(Text.of(["ab"]), 1, {
    send: async (_revision, changes) => (sent.push(changes), valid ? { revision: 2, valid: true } : { revision: 1, valid: false }),
    apply: () => assert.fail("nothing comes from elsewhere"),
  }, 1e6);
  sync.typed(ChangeSet.of({ from: 1, insert: "(" }, 2));
  await sync.flush();
  assert.ok(!sync.isClean);
  valid = true;
  sync.typed(ChangeSet.of({ from: 2, insert: ")" }, 3));
  await sync.flush();
  assert.deepEqual(sent[1], [{ begin: 1, end: 1, insert: "()" }], "places count from the program's text");
  sync.changed({ revision: 2, changes: sent[1] }, true);
  assert.ok(sync.isClean);
  sync.stop();
});

test("a draft that is typed back to what was is given up", async () => {
  const sent: Change[][] = [];
  const sync = new Sync(Text.of(["ab"]), 1, {
    send: async (_revision, changes) => (sent.push(changes), { revision: 1, valid: changes.length === 0 }),
    apply: () => assert.fail("nothing comes from elsewhere"),
  }, 1e6);
  sync.typed(ChangeSet.of({ from: 1, insert: "(" }, 2));
  await sync.flush();
  sync.typed(ChangeSet.of({ from: 1, to: 2 }, 3));
  await sync.flush();
  assert.deepEqual(sent[1], [], "no changes: the program forgets the draft");
  assert.ok(sync.isClean);
  await sync.flush();
  assert.equal(sent.length, 2, "once");
  sync.stop();
});

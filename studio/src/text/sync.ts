// Keeps the editor's text and the program's the same while both change: what is typed is sent when it rests, one request at a time;
// what comes from elsewhere meanwhile is put in beneath it.
import { ChangeSet, type ChangeSpec, type Text } from "@codemirror/state";
import type { Problem, TextState } from "../model/protocol.ts";

export interface Asker {
  /** Sends changes of the text of `revision`, or none, which gives up a draft; resolves when the program has answered. */
  send: (revision: number, changes: { begin: number; end: number; insert: string }[]) => Promise<Answer>;
  /** What the editor must show besides: changes that come from elsewhere. */
  apply: (changes: ChangeSet) => void;
}

export interface Answer {
  revision?: number;
  valid?: boolean;
  errors?: Problem[];
  /** The program's text has become another one meanwhile. */
  stale?: boolean;
}

export class Sync {
  /** The program's text, as far as it is known here. */
  private base: Text;
  private revision: number;
  /** What was sent and is not confirmed yet, and what was typed after it. */
  private sent: ChangeSet | null = null;
  private unsent: ChangeSet;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private ownRevision = -1;
  /** The program keeps what was sent as a draft, since it is not valid. */
  private draft = false;

  constructor(
    text: Text,
    revision: number,
    private readonly asker: Asker,
    private readonly rest = 250,
  ) {
    this.base = text;
    this.revision = revision;
    this.unsent = ChangeSet.empty(text.length);
  }

  get isClean(): boolean {
    return this.sent === null && this.unsent.empty;
  }

  /** Somebody has typed. */
  typed(changes: ChangeSet): void {
    this.unsent = this.unsent.compose(changes);
    this.later();
  }

  async flush(): Promise<void> {
    this.stop();
    if (this.sent || (this.unsent.empty && !this.draft)) return;
    const sending = this.unsent;
    this.sent = sending;
    this.unsent = ChangeSet.empty(sending.newLength);
    const answer = await this.asker.send(this.revision, toList(sending));
    if (!answer.stale) this.draft = answer.valid === false;
    if (this.sent && sending.empty) this.sent = null; // only the draft is gone
    if (this.sent) {
      if (answer.valid !== false && !answer.stale && answer.revision !== undefined && answer.revision >= this.revision) {
        // The event with the change may come before or after the answer.
        this.ownRevision = answer.revision;
        if (this.revision >= answer.revision) this.confirm();
      } else {
        this.unsent = this.sent.compose(this.unsent);
        this.sent = null;
        if (answer.stale) this.later();
      }
    }
    if (!this.sent && answer.valid !== false && !this.unsent.empty) this.later();
  }

  /** The program's text has changed: by us, or by somebody else. */
  changed(event: TextState, byUs: boolean): void {
    if (event.revision <= this.revision) return;
    if (byUs && this.sent) {
      this.base = this.sent.apply(this.base);
      this.revision = event.revision;
      this.sent = null;
      if (!this.unsent.empty) this.later();
      return;
    }
    const changes = ChangeSet.of((event.changes ?? []).map(toSpec), this.base.length);
    this.base = changes.apply(this.base);
    this.revision = event.revision;
    // Brought past what is typed here.
    let theirs = changes;
    if (this.sent) {
      const moved = this.sent.map(theirs);
      theirs = theirs.map(this.sent, true);
      this.sent = moved;
    }
    const moved = this.unsent.map(theirs);
    theirs = theirs.map(this.unsent, true);
    this.unsent = moved;
    if (!theirs.empty) this.asker.apply(theirs);
  }

  /** The same text has another revision. Says whether it is the same. */
  rebased(text: string, revision: number): boolean {
    if (text !== this.base.toString()) return false;
    this.revision = revision;
    return true;
  }

  /** Gives up what the program has not taken; returns the text it has. */
  drop(): Text {
    this.stop();
    this.sent = null;
    this.draft = false;
    this.unsent = ChangeSet.empty(this.base.length);
    return this.base;
  }

  /** Nothing is sent by itself any more. */
  stop(): void {
    clearTimeout(this.timer);
  }

  private later(): void {
    this.stop();
    this.timer = setTimeout(() => void this.flush(), this.rest);
  }

  private confirm(): void {
    if (this.sent && this.ownRevision === this.revision) {
      this.base = this.sent.apply(this.base);
      this.sent = null;
    }
  }
}

function toSpec(change: { begin: number; end: number; insert: string }): ChangeSpec {
  return { from: change.begin, to: change.end, insert: change.insert };
}

function toList(changes: ChangeSet): { begin: number; end: number; insert: string }[] {
  const list: { begin: number; end: number; insert: string }[] = [];
  changes.iterChanges((from, to, _fromNew, _toNew, inserted) => list.push({ begin: from, end: to, insert: inserted.toString() }));
  return list;
}

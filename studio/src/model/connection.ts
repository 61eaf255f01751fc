// The WebSocket to the program: requests with replies, events, pixels. Connects again by itself when the line is lost.
import { Refused, type Event, type Problem, type Reply } from "./protocol.ts";

interface Waiting {
  resolve: (reply: Reply) => void;
  reject: (error: Error) => void;
}

export type Line = "connecting" | "open" | "lost" | "closed";

export interface Listener {
  /** The line is open: time to say hello. */
  opened: () => void;
  line: (line: Line) => void;
  event: (event: Event) => void;
  pixels: (message: ArrayBuffer) => void;
}

export class Connection {
  private socket: WebSocket | null = null;
  private readonly waiting = new Map<number, Waiting>();
  private last = 0;
  private failures = 0;
  private ended = false;

  constructor(
    private readonly address: string,
    private readonly listener: Listener,
  ) {}

  connect(): void {
    if (!this.ended) this.listener.line(this.failures ? "lost" : "connecting");
    const socket = new WebSocket(this.address);
    socket.binaryType = "arraybuffer";
    this.socket = socket;
    socket.onopen = () => {
      this.failures = 0;
      this.ended = false;
      this.listener.line("open");
      this.listener.opened();
    };
    socket.onmessage = ({ data }) => {
      if (data instanceof ArrayBuffer) this.listener.pixels(data);
      else this.take(String(data));
    };
    socket.onclose = () => this.lost(socket);
  }

  /** The program says goodbye: it ends, or begins again, which is looked for during some minutes. */
  end(): void {
    this.ended = true;
    this.listener.line("closed");
  }

  /** The number the next request will have. */
  get next(): number {
    return this.last + 1;
  }

  /** Resolves with the reply; rejects with `Refused` if the program refuses, with another error if the line is lost. */
  ask<T = Reply>(what: string, with_: Record<string, unknown> = {}): Promise<T> {
    const id = ++this.last;
    if (this.socket?.readyState !== WebSocket.OPEN) return Promise.reject(new Error("offline"));
    this.socket.send(JSON.stringify({ id, do: what, ...with_ }));
    return new Promise<Reply>((resolve, reject) => this.waiting.set(id, { resolve, reject })) as Promise<T>;
  }

  private take(text: string): void {
    const message = JSON.parse(text) as Reply | Event;
    if ("event" in message && typeof message.event === "string") {
      this.listener.event(message as Event);
      return;
    }
    const reply = message as Reply;
    const waiting = this.waiting.get(reply.id);
    if (!waiting) return;
    this.waiting.delete(reply.id);
    if (reply.ok) waiting.resolve(reply);
    else waiting.reject(new Refused((reply.errors as Problem[] | undefined) ?? [{ message: "refused" }]));
  }

  private lost(socket: WebSocket): void {
    if (socket !== this.socket) return;
    for (const { reject } of this.waiting.values()) reject(new Error("offline"));
    this.waiting.clear();
    ++this.failures;
    if (this.ended) {
      if (this.failures < 150) setTimeout(() => this.connect(), 2000);
      return;
    }
    this.listener.line("lost");
    setTimeout(() => this.connect(), Math.min(5000, 250 * 2 ** Math.min(this.failures, 5)));
  }
}

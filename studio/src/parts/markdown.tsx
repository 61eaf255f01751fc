// The little Markdown that manual pages and hints use: headings, paragraphs, lists, tables, code, emphasis. No HTML, no links that leave the page.
import type { ComponentChildren, JSX } from "preact";

export function Markdown({ text }: { text: string }): JSX.Element {
  const blocks: JSX.Element[] = [];
  const lines = text.split("\n");
  for (let i = 0; i < lines.length; ) {
    const line = lines[i] as string;
    const take = (test: (l: string) => boolean): string[] => {
      const from = i;
      while (i < lines.length && test(lines[i] as string)) ++i;
      return lines.slice(from, i);
    };
    if (/^\s*$/.test(line)) ++i;
    else if (line.startsWith("```")) {
      ++i;
      const code = take((l) => !l.startsWith("```"));
      ++i;
      blocks.push(<pre tabIndex={0}>{code.join("\n")}</pre>);
    } else if (/^#{1,6}\s/.test(line)) {
      blocks.push(<h4>{inline(line.replace(/^#+\s*/, ""))}</h4>);
      ++i;
    } else if (line.startsWith("|")) blocks.push(table(take((l) => l.startsWith("|"))));
    else if (/^[-*]\s/.test(line)) {
      const items = take((l) => /^([-*]\s|\s+\S)/.test(l)).join("\n").split(/\n(?=[-*]\s)/);
      blocks.push(<ul>{items.map((item) => <li>{inline(item.replace(/^[-*]\s/, "").replace(/\s*\n\s*/g, " "))}</li>)}</ul>);
    } else blocks.push(<p>{inline(take((l) => l.trim() !== "" && !/^(```|#|\||[-*]\s)/.test(l)).join(" ") || (lines[i++] as string))}</p>);
  }
  return <div class="markdown">{blocks}</div>;
}

function table(lines: string[]): JSX.Element {
  const cells = (line: string): string[] => line.replace(/^\||\|\s*$/g, "").split(/(?<!\\)\|/).map((c) => c.trim().replace(/\\\|/g, "|"));
  const [head, , ...rest] = lines;
  return (
    <table>
      <thead><tr>{cells(head ?? "").map((c) => <th>{inline(c)}</th>)}</tr></thead>
      <tbody>{rest.map((r) => <tr>{cells(r).map((c) => <td>{inline(c)}</td>)}</tr>)}</tbody>
    </table>
  );
}

/** Words with code and emphasis in them. */
export function inline(text: string): ComponentChildren {
  return text.split(/(`[^`]+`|\*\*[^*]+\*\*|\[[^\]]*\]\([^)]*\))/).map((part) => {
    if (part.startsWith("`")) return <code>{part.slice(1, -1)}</code>;
    if (part.startsWith("**")) return <b>{part.slice(2, -2)}</b>;
    const link = /^\[([^\]]*)\]\(/.exec(part);
    return link ? (link[1] ?? "").replace(/`/g, "") : part;
  });
}

// What the browser keeps between visits: sizes, the theme. Nothing of the document.

type Kept<T> = T extends number ? number : T extends boolean ? boolean : T;

export function remembered<T extends string | number | boolean>(name: string, otherwise: T): Kept<T> {
  try {
    const text = localStorage.getItem(`etendue.${name}`);
    if (text === null) return otherwise as Kept<T>;
    const value: unknown = JSON.parse(text);
    return (typeof value === typeof otherwise ? value : otherwise) as Kept<T>;
  } catch {
    return otherwise as Kept<T>; // private windows may forbid it
  }
}

export function remember(name: string, value: string | number | boolean): void {
  try {
    localStorage.setItem(`etendue.${name}`, JSON.stringify(value));
  } catch {
    // then it is forgotten
  }
}

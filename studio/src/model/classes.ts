// What is known of classes: the descriptions the program gives (`etendue classes --json`), and questions to them.

export interface Range {
  low?: number;
  more_than?: number;
  high?: number;
  less_than?: number;
}

/** One condition of `when`; all must hold for a member to matter. */
export interface Condition {
  member: string;
  is?: unknown[];
  is_not?: unknown[];
  given?: boolean;
}

export interface Member {
  name: string;
  type: string;
  class?: string;
  list?: boolean;
  required?: boolean;
  unit?: string;
  default?: unknown;
  range?: Range;
  slider?: [number, number];
  logarithmic?: boolean;
  choices?: string[];
  meaning?: string;
  group?: string;
  when?: Condition[];
  effect?: "none" | "retone" | "rerender" | "rebuild";
  declared_by?: string;
  text: string;
}

export interface ClassInfo {
  name: string;
  parent?: string;
  abstract: boolean;
  summary: string;
  source?: string;
  members: Member[];
  subclasses: string[];
}

export class Classes {
  private readonly byName = new Map<string, ClassInfo>();
  private readonly children = new Map<string, string[]>();

  constructor(readonly all: ClassInfo[]) {
    for (const info of all) {
      this.byName.set(info.name, info);
      if (info.parent) this.children.set(info.parent, [...(this.children.get(info.parent) ?? []), info.name]);
    }
  }

  find(name: string): ClassInfo | undefined {
    return this.byName.get(name);
  }

  member(className: string, member: string): Member | undefined {
    return this.find(className)?.members.find((m) => m.name === member);
  }

  /** Whether the classes of all components are known, with the members that the components have. */
  describe(components: Iterable<{ class: string; members: Record<string, unknown> }>): boolean {
    const seen = new Set<string>();
    for (const component of components) {
      if (seen.has(component.class)) continue;
      seen.add(component.class);
      const known = this.find(component.class)?.members;
      if (known?.length !== Object.keys(component.members).length) return false;
      if (!known.every((m) => m.name in component.members)) return false;
    }
    return true;
  }

  /** Whether a component of class `name` may stand where one of class `wanted` is expected. */
  isA(name: string, wanted: string): boolean {
    for (let at = this.find(name); at; at = at.parent ? this.find(at.parent) : undefined) {
      if (at.name === wanted) return true;
    }
    return false;
  }

  /** All classes of which a component may stand where one of class `wanted` is expected, by name. */
  offered(wanted: string): ClassInfo[] {
    const found: ClassInfo[] = [];
    const visit = (name: string): void => {
      const info = this.find(name);
      if (info && !info.abstract) found.push(info);
      for (const child of this.children.get(name) ?? []) visit(child);
    };
    visit(wanted);
    return found.sort((a, b) => a.name.localeCompare(b.name));
  }

  /** The kind a class belongs to: the uppermost of its parents, or itself. */
  kind(name: string): string {
    let info = this.find(name);
    while (info?.parent && this.find(info.parent)) info = this.find(info.parent);
    return info?.name ?? name;
  }
}

/** Whether a value counts as nothing: false, 0, "", an empty list, none. */
export function isNothing(value: unknown): boolean {
  if (value === undefined || value === null || value === false || value === 0 || value === "") return true;
  if (Array.isArray(value)) return value.length === 0 || value.every((v) => typeof v === "number" && v === 0);
  return false;
}

/** Whether a member matters, as its conditions say, in a component with these values. */
export function matters(member: Member, valueOf: (name: string) => unknown): boolean {
  return (member.when ?? []).every((condition) => {
    const value = valueOf(condition.member);
    if (condition.is && !condition.is.includes(value)) return false;
    if (condition.is_not?.includes(value)) return false;
    return condition.given === undefined || condition.given === !isNothing(value);
  });
}

export interface Group {
  name: string;
  members: Member[];
}

/** The members in groups, each in the order in which it is first met; those without one come first, under "". */
export function groups(members: Member[]): Group[] {
  const found = new Map<string, Member[]>([["", []]]);
  for (const member of members) {
    const name = member.group ?? "";
    const group = found.get(name);
    if (group) group.push(member);
    else found.set(name, [member]);
  }
  return [...found].filter(([, m]) => m.length > 0).map(([name, m]) => ({ name, members: m }));
}

/** The groups of a class: those in which it declares something itself come before those it has from its parents alone. */
export function ownGroupsFirst(info: ClassInfo): Group[] {
  const all = groups(info.members);
  const own = (g: Group): boolean => g.members.some((m) => m.declared_by === info.name);
  return [...all.filter(own), ...all.filter((g) => !own(g))];
}

/** A default as the render description language would write it. */
export function writeDefault(value: unknown, type = ""): string {
  if (value === null || value === undefined) return "none";
  if (typeof value === "string") return type === "string" || type === "file" ? JSON.stringify(value) : value;
  if (Array.isArray(value)) return `[${value.map((v) => writeDefault(v, type)).join(", ")}]`;
  if (typeof value === "object") {
    const { class: name, ...rest } = value as Record<string, unknown>;
    if (name === "ConstantMap" && typeof rest.value === "string" && Object.keys(rest).length === 1) return rest.value;
    const inner = Object.entries(rest).map(([k, v]) => `${k}: ${writeDefault(v)}`);
    return inner.length ? `${String(name)} { ${inner.join(", ")} }` : `${String(name)} {}`;
  }
  return String(value);
}

import assert from "node:assert/strict";
import { test } from "node:test";
import { Classes, groups, isNothing, matters, ownGroupsFirst, writeDefault, type Member } from "../../../studio/src/model/classes.ts";
import type { Component, Use } from "../../../studio/src/model/protocol.ts";
import { rows, slots } from "../../../studio/src/tree/rows.ts";

const member = (name: string, more: Partial<Member> = {}): Member => ({ name, type: "number", text: "", ...more });
const known = new Classes([
  { name: "SceneObject", abstract: true, summary: "", members: [], subclasses: [] },
  { name: "Sphere", parent: "SceneObject", abstract: false, summary: "", subclasses: [], members: [member("place", { group: "Placement", declared_by: "SceneObject" }), member("radius", { group: "Shape", declared_by: "Sphere" })] },
  { name: "Scene", parent: "SceneObject", abstract: true, summary: "", subclasses: [], members: [] },
  { name: "BvhScene", parent: "Scene", abstract: false, summary: "", subclasses: [], members: [member("objects", { type: "component", class: "SceneObject", list: true })] },
  { name: "Job", abstract: false, summary: "", subclasses: [], members: [member("scene", { type: "component", class: "Scene", required: true })] },
]);

test("every class that may stand in a place is offered, and no other", () => {
  assert.deepEqual(known.offered("SceneObject").map((c) => c.name), ["BvhScene", "Sphere"]);
  assert.deepEqual(known.offered("Scene").map((c) => c.name), ["BvhScene"]);
  assert.ok(known.isA("BvhScene", "SceneObject") && !known.isA("SceneObject", "BvhScene"));
  assert.equal(known.kind("BvhScene"), "SceneObject");
});

test("members matter when all conditions hold", () => {
  const values: Record<string, unknown> = { kind: "oil", varnished: true, file: "" };
  const of = (name: string): unknown => values[name];
  assert.ok(matters(member("a", { when: [{ member: "kind", is: ["oil"] }] }), of));
  assert.ok(!matters(member("a", { when: [{ member: "kind", is_not: ["oil"] }] }), of));
  assert.ok(!matters(member("a", { when: [{ member: "varnished", given: true }, { member: "file", given: true }] }), of));
  assert.ok([false, 0, "", null, [], [0, 0]].every(isNothing));
});

test("groups keep their order; a class's own come first", () => {
  assert.deepEqual(groups(known.find("Sphere")?.members ?? []).map((g) => g.name), ["Placement", "Shape"]);
  const sphere = known.find("Sphere");
  assert.ok(sphere);
  assert.deepEqual(ownGroupsFirst(sphere).map((g) => g.name), ["Shape", "Placement"]);
});

test("defaults as the language writes them", () => {
  assert.equal(writeDefault(null), "none");
  assert.equal(writeDefault({ class: "ConstantMap", value: "0.5" }), "0.5");
  assert.equal(writeDefault({ class: "PathTracer" }), "PathTracer {}");
  assert.equal(writeDefault("a", "string"), '"a"');
  assert.equal(writeDefault([0, 1]), "[0, 1]");
});

const part = (id: number, name: string, uses: Use[], members: Component["members"] = {}): Component => ({ id, class: name, name: null, written: "text", uses, members });
const state = (value: Component["members"][string]["value"]): Component["members"][string] => ({ written: true, text: "", value, matters: true });
const tree = new Map([
  part(1, "Job", [], { scene: state({ component: 2 }) }),
  part(2, "BvhScene", [{ id: 1, member: "scene" }], { objects: state([{ component: 3 }, { component: 3 }]) }),
  part(3, "Sphere", [{ id: 2, member: "objects", index: 0 }, { id: 2, member: "objects", index: 1 }]),
].map((c) => [c.id, c]));

test("a shared component has a row at each of its places, and is found once", () => {
  const wanted = { opened: new Map<number, boolean>(), defaults: false, search: "" };
  assert.deepEqual(rows(1, tree, known, wanted).map((r) => [r.component.id, r.depth, r.use?.index]), [[1, 0, undefined], [2, 1, undefined], [3, 2, 0], [3, 2, 1]]);
  assert.deepEqual(rows(1, tree, known, { ...wanted, opened: new Map([[2, false]]) }).map((r) => r.expanded), [true, false]);
  assert.equal(rows(1, tree, known, { ...wanted, search: "sph" }).length, 1);
});

test("a thing is added behind what is selected in a list, and into a scene that is selected", () => {
  const sphere = tree.get(3) as Component;
  assert.deepEqual(slots(sphere, sphere.uses[0] as Use, tree, known).map((s) => [s.component.id, s.index])[0], [2, 1]);
  assert.deepEqual(slots(tree.get(2) as Component, { id: 1, member: "scene" }, tree, known).map((s) => [s.component.id, s.member.name, s.index])[0], [2, "objects", undefined]);
});

test("components tell when a plugin has brought or changed classes", () => {
  const place = state(1);
  const sphere = (name: string, members: Component["members"]): boolean => known.describe([part(4, name, [], members)]);
  assert.ok(known.describe([...tree.values()].filter((c) => c.class !== "Sphere")));
  assert.ok(sphere("Sphere", { place, radius: place }));
  assert.ok(!sphere("Sphere", { place, radius: place, added: place }));
  assert.ok(!sphere("Sphere", { place }));
  assert.ok(!sphere("Sphere", { place, renamed: place }));
  assert.ok(!sphere("Marble", { place }));
});

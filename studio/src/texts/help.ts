// The texts of the help.

export const help = {
  title: "Help and keyboard shortcuts",
  version: (v: string) => `Étendue ${v}`,
  licences: "Licences of the libraries in this page",
  groups: [
    {
      name: "Everywhere",
      keys: [
        ["Ctrl+S", "save; with Shift under another name"],
        ["Ctrl+O", "open"],
        ["Ctrl+Z", "undo; with Shift redo"],
        ["Ctrl+Enter", "start or pause the render"],
        ["Alt+1, 2, 3, 4", "picture, text, 3D view, side by side"],
        ["F6", "next panel of the window"],
        ["F1", "this help"],
      ],
    },
    {
      name: "Scene",
      keys: [
        ["Arrows", "move through the tree; expand and collapse"],
        ["Enter", "go to the properties"],
        ["Insert", "add a component"],
        ["Delete", "remove it"],
        ["Ctrl+D", "duplicate it"],
        ["Alt+↑ ↓", "move it up or down in its list"],
        ["F2", "rename it"],
      ],
    },
    {
      name: "Picture",
      keys: [
        ["Arrows", "move the pixel cursor, by ten pixels with Shift; with Orbit, move the camera"],
        ["+ −", "zoom; F fits to the window, 1 shows actual pixels"],
        ["E", "increase the exposure; with Shift decrease; 0 resets"],
        ["Wheel", "zoom; drag to pan"],
        ["W A S D, Q E", "with Fly, move the camera; faster with Shift"],
        ["Shift, Ctrl + drag", "with Orbit, pan; dolly"],
        ["Enter", "select the object or show the paths of the pixel, depending on the tool"],
      ],
    },
    {
      name: "Numbers",
      keys: [
        ["30 cm", "units, names and arithmetic are allowed"],
        ["↑ ↓", "a small step up or down; ten times as large with Shift"],
        ["Escape", "restore the value"],
      ],
    },
  ] as { name: string; keys: [string, string][] }[],
};

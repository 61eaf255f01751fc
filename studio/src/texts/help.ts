// What the help says.

export const help = {
  title: "Help and keys",
  version: (v: string) => `Étendue ${v}`,
  licences: "Licences of what this page is made with",
  groups: [
    {
      name: "Everywhere",
      keys: [
        ["Ctrl+S", "save; with Shift under another name"],
        ["Ctrl+O", "open"],
        ["Ctrl+Z", "undo; with Shift do it again"],
        ["Ctrl+Enter", "start or pause the render"],
        ["Alt+1, 2, 3, 4", "picture, text, space, side by side"],
        ["F6", "to the next part of the window"],
        ["F1", "this help"],
      ],
    },
    {
      name: "Scene",
      keys: [
        ["Arrows", "go through the tree, open and close"],
        ["Enter", "to the properties"],
        ["Insert", "add a component"],
        ["Delete", "remove it"],
        ["Ctrl+D", "duplicate it"],
        ["Alt+↑ ↓", "move it among its neighbours"],
        ["F2", "name it"],
      ],
    },
    {
      name: "Picture",
      keys: [
        ["Arrows", "from pixel to pixel, ten with Shift; the camera when it is being moved"],
        ["+ −", "zoom; F fits, 1 is pixel by pixel"],
        ["E", "brighter; with Shift darker; 0 as it is"],
        ["Wheel", "zoom; drag to pan"],
        ["W A S D, Q E", "fly, when the camera is being flown; with Shift faster"],
        ["Shift, Ctrl + drag", "with the camera: pan, come nearer"],
        ["Enter", "select the object, or show the paths of the pixel"],
      ],
    },
    {
      name: "Numbers",
      keys: [
        ["30 cm", "any unit of the dimension, names and arithmetic are understood"],
        ["↑ ↓", "a little more or less, ten times as much with Shift"],
        ["Escape", "back to what it was"],
      ],
    },
  ] as { name: string; keys: [string, string][] }[],
};

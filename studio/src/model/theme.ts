// Light or dark: as the system says, or as chosen.
import { computed, effect, signal } from "@preact/signals";
import { remember, remembered } from "./memory.ts";

export type Theme = "system" | "light" | "dark";
export const theme = signal<Theme>(remembered<Theme>("theme", "system"));

const query = window.matchMedia("(prefers-color-scheme: dark)");
const systemDark = signal(query.matches);
query.addEventListener("change", () => (systemDark.value = query.matches));

export const isDark = computed(() => (theme.value === "system" ? systemDark.value : theme.value === "dark"));

effect(() => {
  document.documentElement.dataset.theme = isDark.value ? "dark" : "light";
  remember("theme", theme.value);
});

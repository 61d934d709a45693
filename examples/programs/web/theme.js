// SPDX-License-Identifier: MPL-2.0
// Dark or light: as the system has it, until somebody chooses.
const key = "scifi-theme";

const stored = () => {
  try { return localStorage.getItem(key); } catch { return null; }
};

export function startTheme(button, changed) {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const apply = (theme) => {
    document.documentElement.dataset.theme = theme;
    changed();
  };
  apply(stored() ?? (system.matches ? "dark" : "light"));
  system.addEventListener("change", () => { if (!stored()) apply(system.matches ? "dark" : "light"); });
  button.addEventListener("click", () => {
    const theme = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    try { localStorage.setItem(key, theme); } catch { /* a file system without storage: the choice lasts as long as the page */ }
    apply(theme);
  });
}

export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

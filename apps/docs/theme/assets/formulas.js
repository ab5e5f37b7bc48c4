for (const element of document.querySelectorAll(".arithmatex")) {
  const text = element.textContent;  // \(...\) or \[...\]
  katex.render(text.slice(2, -2), element, {displayMode: text.startsWith("\\["), throwOnError: false});
}

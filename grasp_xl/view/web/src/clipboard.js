// Copying a text field, also where a page that is a file has no right to the clipboard.

/** Copy what a text field holds; true if it worked, else it is selected. */
export async function copyField(field) {
  try {
    await navigator.clipboard.writeText(field.value);
    return true;
  } catch {
    field.focus();
    field.select();
    return document.execCommand("copy");
  }
}

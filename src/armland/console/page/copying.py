"""A command on the page, with a button that copies it."""

from html import escape

LABEL = "copy the command that does this again"

# Browsers give pages their clipboard only on this machine or encrypted; elsewhere a field that is selected does it.
# Keys that press the button are not the page's own, such as Enter, which starts a flight.
SCRIPT = """
const b = this, text = b.nextElementSibling.textContent;
const done = () => { b.textContent = 'copied'; b.blur(); setTimeout(() => { b.textContent = b.dataset.label }, 1500) };
const old = () => {
  const t = document.createElement('textarea');
  t.value = text; document.body.append(t); t.select(); document.execCommand('copy'); t.remove(); done();
};
if (navigator.clipboard) navigator.clipboard.writeText(text).then(done, old); else old();
"""

BUTTON = (
    "flex:none;font-size:11px;padding:3px 8px;border-radius:4px;border:0;background:#0072B2;color:#fff;cursor:pointer"
)
CODE = "flex:1;font-size:11px;overflow:hidden;text-overflow:ellipsis;white-space:nowrap;user-select:all"


def command_html(command: str, note: str = "") -> str:
    """The command on one line beside its button, with a note below; all of it is shown when pointed at."""
    script = " ".join(line.strip() for line in SCRIPT.splitlines())
    below = f'<div style="font-size:11px">{escape(note)}</div>' if note else ""
    return (
        '<div style="padding:2px 10px 5px"><div style="display:flex;gap:8px;align-items:center">'
        f'<button type="button" data-label="{LABEL}" style="{BUTTON}" onkeydown="event.stopPropagation()" '
        f'onclick="{escape(script)}">{LABEL}</button>'
        f'<code title="{escape(command)}" data-command="1" style="{CODE}">{escape(command)}</code></div>{below}</div>'
    )

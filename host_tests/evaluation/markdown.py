"""A page as a list of blocks, written as Markdown and as one self-contained HTML file."""
import base64
import html
import mimetypes
import re

STYLE = """body{font:16px/1.5 sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:1em 0;font-size:.92em}td,th{border:1px solid #ccc;padding:.25em .6em;text-align:right}
.words{text-align:left}th{background:#f2f2f2}figure{margin:1.5em 0}img{max-width:100%}
figcaption{color:#444;font-size:.92em}code,pre{background:#f5f5f5}pre{padding:.6em;overflow-x:auto}"""


class Page:
    def __init__(self, title):
        self.title = title
        self.blocks = []

    def heading(self, text):
        self.blocks.append(("heading", text))

    def text(self, text):
        self.blocks.append(("text", " ".join(text.split())))

    def items(self, items):
        self.blocks.append(("items", [" ".join(item.split()) for item in items]))

    def code(self, text):
        self.blocks.append(("code", text))

    def table(self, header, rows):
        self.blocks.append(("table", ([str(cell) for cell in header], [[str(cell) for cell in row] for row in rows])))

    def figure(self, path, caption):
        self.blocks.append(("figure", (path, " ".join(caption.split()))))

    def write(self, folder):
        (folder / "README.md").write_text(self.as_markdown(folder))
        (folder / "index.html").write_text(self.as_html())

    def as_markdown(self, folder):
        parts = [f"# {self.title}"] + [MARKDOWN[kind](content, folder) for kind, content in self.blocks]
        return "\n\n".join(parts) + "\n"

    def as_html(self):
        body = "\n".join(HTML[kind](content) for kind, content in self.blocks)
        title = html.escape(self.title)
        return (f"<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\n"
                f"<style>{STYLE}</style></head><body>\n<h1>{title}</h1>\n{body}\n</body></html>\n")


def word_columns(rows):
    """For each column whether it holds words: those stand on the left, numbers on the right."""
    return [place == 0 or any(re.search("[A-Za-z]{3}", cell) for cell in column) for place, column in enumerate(zip(*rows))]


def markdown_table(content, _):
    header, rows = content
    lines = ["| " + " | ".join(header) + " |", "|" + "".join("---|" if words else "---:|" for words in word_columns(rows))]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def markdown_figure(content, folder):
    path, caption = content
    return f"![{caption.split('.')[0]}]({path.relative_to(folder)})\n\n*{caption}*"


MARKDOWN = {
    "heading": lambda text, _: f"## {text}",
    "text": lambda text, _: text,
    "items": lambda items, _: "\n".join(f"- {item}" for item in items),
    "code": lambda text, _: "\n".join("    " + line for line in text.splitlines()),
    "table": markdown_table,
    "figure": markdown_figure,
}


def inline(text):
    """The little of Markdown that the texts use: `code`, **bold**, *emphasis*, [links](somewhere)."""
    text = html.escape(text, quote=False)
    text = re.sub(r"`([^`]+)`", r"<code>\1</code>", text)
    text = re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", text)
    text = re.sub(r"\*([^*]+)\*", r"<i>\1</i>", text)
    text = re.sub(r"(\d) %", "\\1\u00a0%", text)
    return re.sub(r"\[([^\]]+)\]\(([^)]+)\)", r'<a href="\2">\1</a>', text)


def html_table(content):
    header, rows = content
    marks = [' class="words"' if words else "" for words in word_columns(rows)]
    lines = ["<tr>" + "".join(f"<{kind}{mark}>{inline(cell)}</{kind}>" for cell, mark in zip(row, marks)) + "</tr>"
             for kind, row in [("th", header), *(("td", row) for row in rows)]]
    return "<table>\n" + "\n".join(lines) + "\n</table>"


def html_figure(content):
    path, caption = content
    kind = mimetypes.guess_type(path.name)[0]
    data = base64.b64encode(path.read_bytes()).decode()
    return (f'<figure><img alt="{html.escape(caption.split(".")[0])}" src="data:{kind};base64,{data}">'
            f"<figcaption>{inline(caption)}</figcaption></figure>")


HTML = {
    "heading": lambda text: f"<h2>{inline(text)}</h2>",
    "text": lambda text: f"<p>{inline(text)}</p>",
    "items": lambda items: "<ul>" + "".join(f"<li>{inline(item)}</li>" for item in items) + "</ul>",
    "code": lambda text: f"<pre>{html.escape(text)}</pre>",
    "table": html_table,
    "figure": html_figure,
}

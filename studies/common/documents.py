"""Tables that programs write into documents, between two marks."""


def put_between(document, marks, text):
    """`text` in place of what the document has between the marks; newlines beside the marks are the text's."""
    whole = document.read_text()
    document.write_text(f"{whole.split(marks[0])[0]}{marks[0]}{text}{marks[1]}{whole.split(marks[1])[1]}")

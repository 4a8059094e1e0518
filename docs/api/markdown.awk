# The guides as Doxygen wants them. Headings get the labels that hosting sites derive from their text, with the file's
# name before them, and a letter before that, so that links to a heading work here too. Files outside docs are no pages: links to them become
# their names. A link's text may have begun in the line before, so only `](target)` is looked at.
function label(text) {
    text = tolower(text)
    gsub(/[^a-z0-9 _-]/, "", text)
    gsub(/ /, "-", text)
    return text
}

# Replaces the match of the last match() in the line.
function replace(by) {
    $0 = substr($0, 1, RSTART - 1) by substr($0, RSTART + RLENGTH)
}

BEGIN {
    page = ARGV[1]
    gsub(/.*\/|\.md$/, "", page)
}

/^```/ { fenced = !fenced }
fenced { print; next }

{
    gsub(/\]\(#/, "](#page-" page "-")
    while (match($0, /\]\([a-z0-9_\/]+\.md#/)) {
        target = substr($0, RSTART + 2, RLENGTH - 6)
        sub(/.*\//, "", target)
        replace("](#page-" target "-")
    }
    while (match($0, /\]\(\.\.\/[^)]*\)/)) replace("] (" substr($0, RSTART + 5, RLENGTH - 6) ")")
}

/^##+ / {
    text = $0
    sub(/^#+ /, "", text)
    $0 = $0 " {#page-" page "-" label(text) "}"
}

{ print }

# The header's comments as Doxygen wants them: the first comment describes the file, its paragraphs and the lines
# "Errors:", "Cost:", "Owner:" have headings, names in backquotes are links.
1s|^/\* |/** \\file\n * \\brief |
s|^ \* (Paper\|Sides\|Units\|Time\|Status\|Threads\|Owner\|Cost\|Structs\|Fortran): | * \\par \1\n * |
s|^( *)/// (Errors\|Cost\|Owner): |\1/// \\par \2\n\1/// |
s|`(stickslip_[a-z_]+)`|\\ref \1|g

# Files outside docs are no pages of the rendered reference: links to them become their names.
s|\[([^]]*)\]\(\.\./[^)]*\)|\1|g

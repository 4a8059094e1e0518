/* The table of keys as a text. */
#ifndef STICKSLIP_PROGRAM_KEYS_PRINT_H
#define STICKSLIP_PROGRAM_KEYS_PRINT_H
#include <stdbool.h>

/* for people; of one item, or "": of all. False: no item is called so */
bool keys_print(const char *item);
/* the tables of the pages, each behind a line with its page and the words of its marks there */
void keys_print_markdown(void);
/* which items there are, to the standard error */
void keys_print_items(void);
#endif

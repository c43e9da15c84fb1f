/* The caller's block of memory, handed out in aligned pieces. */
#ifndef RD_WORKSPACE_H
#define RD_WORKSPACE_H

#include <stdbool.h>
#include <stddef.h>

/* With base NULL nothing is handed out and `used` counts what would be needed, so that one
   function both measures and lays out an analysis' arrays. */
struct rd_workspace {
    char *base;  /* aligned as malloc aligns, or NULL to measure */
    size_t size; /* bytes at base */
    size_t used; /* bytes handed out; SIZE_MAX: more than can be addressed */
};

/* count pieces of `size` bytes; NULL while measuring or where the block is too small */
void *rd_take(struct rd_workspace *workspace, size_t count, size_t size);

/* the same where the address is to be a multiple of `alignment` */
void *rd_take_aligned(struct rd_workspace *workspace, size_t count, size_t size, size_t alignment);

/* false where some piece did not fit */
bool rd_workspace_fits(const struct rd_workspace *workspace);

#endif

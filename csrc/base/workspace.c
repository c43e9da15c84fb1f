/* The caller's block of memory, handed out in aligned pieces. */
#include "base/workspace.h"

#include <stdint.h>

enum { ALIGNMENT = 16 };

void *rd_take(struct rd_workspace *workspace, size_t count, size_t size)
{
    const size_t left = SIZE_MAX - ALIGNMENT - workspace->used;
    if (workspace->used > SIZE_MAX - ALIGNMENT || (size > 0 && count > left / size)) {
        workspace->used = SIZE_MAX;
        return NULL;
    }
    const size_t start = workspace->used;
    const size_t bytes = count * size;
    workspace->used += bytes + (ALIGNMENT - bytes % ALIGNMENT) % ALIGNMENT;
    if (workspace->base == NULL || workspace->used > workspace->size)
        return NULL;
    return workspace->base + start;
}

void *rd_take_aligned(struct rd_workspace *workspace, size_t count, size_t size, size_t alignment)
{
    const size_t most = SIZE_MAX / 2 / size;
    char *p = rd_take(workspace, count < most ? count * size + alignment : SIZE_MAX, 1);
    return p ? p + (alignment - (uintptr_t)p % alignment) % alignment : NULL;
}

bool rd_workspace_fits(const struct rd_workspace *workspace)
{
    return workspace->base != NULL && workspace->used <= workspace->size;
}

/* Families of strings. */
#define RD_GRADED 1
#include "graded/width.h"

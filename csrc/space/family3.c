/* Parts of pieces of three coordinates, at several eigenvalues. */
#define WIDE 3
#include "space/family.h"

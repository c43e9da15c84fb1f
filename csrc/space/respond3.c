/* Responses of three coordinates. */
#define WIDE 3
#include "space/respond.h"

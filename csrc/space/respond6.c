/* Responses of six coordinates. */
#define WIDE 6
#include "space/respond.h"

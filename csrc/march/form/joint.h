/* What stands at a node and on its right, in scattering form. */
#ifndef RD_MARCH_JOINT_H
#define RD_MARCH_JOINT_H

#include "march/form/state.h"

/* joint of a stretch at theta; then with its string at a tension */
enum rd_status rd_joint_fill(const struct rd_march *march, size_t stretch);
enum rd_status rd_joint_tighten(const struct rd_march *march, size_t stretch);

#endif

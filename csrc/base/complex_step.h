/* Derivatives by a complex step: df/dx = Im f(x + i h)/h. */
#ifndef RD_COMPLEX_STEP_H
#define RD_COMPLEX_STEP_H

/* h: its square is nothing beside 1, so derivatives are exact */
#define RD_COMPLEX_STEP 0x1p-200

#endif

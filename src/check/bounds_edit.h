/* bounds_edit.h: what bounds.c needs of an edited material. */
#ifndef HNBRDF_CHECK_BOUNDS_EDIT_H
#define HNBRDF_CHECK_BOUNDS_EDIT_H

#include "check/tracked.h"

typedef struct check_edit {
    pair seen;                         /* what the network sees */
    num edited[3], ratio[3], added[3]; /* f_a of the carried kd; over that of the fitted material */
} check_edit;

void check_edit_make(const check_rules *k, hnbrdf_encoding encoding,
                     const hnbrdf_material *material, const pair *p, check_edit *edit);

/* f of channel c before it is clamped. */
num check_edit_compose(const check_rules *k, const check_edit *edit, int c, num correction,
                       num sigmoid, num floor);

#endif

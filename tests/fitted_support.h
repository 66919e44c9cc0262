/* fitted_support.h: what materials were fitted with, in tests. */
#ifndef HNBRDF_TESTS_FITTED_SUPPORT_H
#define HNBRDF_TESTS_FITTED_SUPPORT_H

#include "hnbrdf/hnbrdf.h"

#include <string.h>

/* The material as a hybrid model holds it when nothing else is said: fitted as it is. */
static inline hnbrdf_material as_fitted(hnbrdf_material m)
{
    memcpy(m.fitted.kd, m.kd, sizeof m.kd);
    memcpy(m.fitted.eta, m.eta, sizeof m.eta);
    memcpy(m.fitted.alpha, m.alpha, sizeof m.alpha);
    return m;
}

#endif

/* kernel_float.h: kernel_body.h in float, with the exp and log of core/math.h: they vectorise,
 * and give the same bits everywhere. */
#include "core/math.h"

#define REAL float
#define REAL_EXP(x) hnbrdf_exp(hnbrdf_clamp((x), -80.0f, 80.0f))
#define REAL_EXP_INSIDE(x) hnbrdf_exp(x)
#define REAL_LOG(x) hnbrdf_log(x)
#define REAL_SQRT(x) sqrtf(x)
#define REAL_COS(x) ((float)cos((double)(x)))
#define REAL_SIN(x) ((float)sin((double)(x)))
#include "fit/kernel_body.h"

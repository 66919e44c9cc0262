/* comparison.c: numbers of a device beside those of C, counted. */
#include "check/comparison.h"

#include <math.h>

/* What errors are related to: see check_comparison. */
static double size_of(double reference, check_number_kind number)
{
    return fmax(fabs(reference), number == CHECK_NUMBER_VALUE ? 0x1p-10 : 1.0);
}

static int is_invalid(float device, check_number_kind number)
{
    return (number != CHECK_NUMBER_ANY && !isfinite(device)) ||
           (number == CHECK_NUMBER_VALUE && !(device >= 0.0f));
}

static double spacing_of_floats(double size)
{
    float rounded = (float)size;
    return (double)(nextafterf(rounded, INFINITY) - rounded);
}

/* Is the first worth telling before the second? */
static int worse(int outside, double ulp, const check_comparison *so_far)
{
    if (so_far->outside > 0)
        return 0;
    return outside || ulp > so_far->worst_ulp;
}

void check_comparison_take(check_comparison *comparison, const check_place *place,
                           check_number_kind number)
{
    double device = (double)place->device, reference = (double)place->reference;
    int invalid = is_invalid(place->device, number);
    int equal = device == reference || (isnan(device) && isnan(reference));
    if (!invalid && !(place->bound < (double)INFINITY)) {
        comparison->unbounded++;
        return;
    }
    double error = equal ? 0.0 : fabs(device - reference), size = size_of(reference, number);
    check_place here = *place;
    here.ulp = invalid || isnan(error) ? (double)INFINITY : error / spacing_of_floats(size);
    int outside = invalid || !(here.ulp == 0.0 || error <= here.bound);
    double share = here.ulp == 0.0 ? 0.0 : here.bound > 0.0 ? error / here.bound : (double)INFINITY;
    if (worse(outside, here.ulp, comparison))
        comparison->worst = here;
    comparison->values++;
    comparison->identical += equal && !invalid;
    comparison->outside += (size_t)outside;
    comparison->sum_ulp += here.ulp;
    comparison->worst_ulp = fmax(comparison->worst_ulp, here.ulp);
    double relative = isnan(error) ? (double)INFINITY : error / size;
    comparison->sum_relative += relative;
    comparison->worst_relative = fmax(comparison->worst_relative, relative);
    comparison->worst_share = fmax(comparison->worst_share, share);
}

void check_comparison_add(check_comparison *sum, const check_comparison *more)
{
    if (more->applies && (!sum->applies || worse(more->outside > 0, more->worst_ulp, sum)))
        sum->worst = more->worst;
    sum->applies |= more->applies;
    sum->values += more->values;
    sum->identical += more->identical;
    sum->outside += more->outside;
    sum->unbounded += more->unbounded;
    sum->sum_ulp += more->sum_ulp;
    sum->sum_relative += more->sum_relative;
    sum->worst_ulp = fmax(sum->worst_ulp, more->worst_ulp);
    sum->worst_relative = fmax(sum->worst_relative, more->worst_relative);
    sum->worst_share = fmax(sum->worst_share, more->worst_share);
}

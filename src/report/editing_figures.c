/* editing_figures.c: means over members and families, names of what is compared. */
#include "report/editing.h"

#include <math.h>

const char *editing_way_name(editing_way way)
{
    static const char *const names[EDITING_WAYS] = {"unedited", "edited", "ggx", "frozen"};
    return names[way];
}

const char *editing_way_title(editing_way way)
{
    static const char *const titles[EDITING_WAYS] = {"unedited", "edited", "GGX alone, edited",
                                                     "frozen fit"};
    return titles[way];
}

static const editing_case *find_case(const editing_member *m, int edit)
{
    for (int k = 0; k < m->count; k++)
        if (m->cases[k].edit == edit)
            return &m->cases[k];
    return NULL;
}

static double mean_of_family(const editing_report *r, int family, int edit, editing_way way,
                             int psnr, int *members)
{
    double sum = 0.0;
    int count = 0;
    for (int m = 0; m < r->count; m++) {
        const editing_case *c = r->members[m].done && r->members[m].family == family
                                    ? find_case(&r->members[m], edit)
                                    : NULL;
        if (!c)
            continue;
        sum += psnr ? c->psnr[way] : c->smape[way];
        count++;
    }
    *members += count;
    return count ? sum / count : NAN;
}

double editing_mean(const editing_report *r, int family, int edit, editing_way way, int psnr,
                    int *members)
{
    double sum = 0.0;
    int families = 0, ignored = 0, *count = members ? members : &ignored;
    *count = 0;
    if (family >= 0)
        return mean_of_family(r, family, edit, way, psnr, count);
    for (int f = 0; hnbrdf_family_name(f); f++) {
        double mean = mean_of_family(r, f, edit, way, psnr, count);
        if (isnan(mean))
            continue;
        sum += mean;
        families++;
    }
    return families ? sum / families : NAN;
}

double editing_mean_half(const editing_report *r, int model)
{
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < r->half_count; k++)
        if (r->halves[k].model == model) {
            sum += r->halves[k].smape;
            count++;
        }
    return count ? sum / count : NAN;
}

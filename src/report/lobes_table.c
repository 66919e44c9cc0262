/* lobes_table.c: the lobes with which the materials of a model are sampled, as a table. */
#include "report/lobes_table.h"

#include "base/write.h"

#include <math.h>

/* Along x, with the sign of the scale; 0 where there is no such lobe. */
static double roughness(const hnbrdf_model_desc *desc, const hnbrdf_material *m, int lobe)
{
    double scale = (double)m->lobes.scale[lobe];
    double alpha = fabs(scale) * (desc->kind == HNBRDF_KIND_NEURAL ? 1.0 : (double)m->alpha[0]);
    double held = fmin(fmax(alpha, (double)HNBRDF_MIN_ALPHA), (double)HNBRDF_MAX_ALPHA);
    return scale == 0.0 ? 0.0 : copysign(held, scale);
}

void report_lobes_print(const hnbrdf_model_desc *desc, FILE *file)
{
    fprintf(file, "%-28s %7s  %9s %5s %5s %5s %5s  %9s %5s %5s %5s %5s\n", "material", "alpha",
            "lobe 1", "0", "1/9", "4/9", "1", "lobe 2", "0", "1/9", "4/9", "1");
    for (int i = 0; i < desc->material_count; i++) {
        const hnbrdf_material *m = &desc->materials[i];
        fprintf(file, "%-28s %7.4f", desc->names[i], (double)m->alpha[0]);
        if (m->lobes.scale[0] == 0.0f)
            fprintf(file, "  none: guessed from kd and eta");
        for (int k = 0; k < HNBRDF_LOBES && m->lobes.scale[0] != 0.0f; k++) {
            fprintf(file, "  %9.4f", roughness(desc, m, k));
            for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
                fprintf(file, " %5.2f", (double)m->lobes.share[k][j]);
        }
        putc('\n', file);
    }
}

void report_lobes_write_csv(const void *table, FILE *file)
{
    const hnbrdf_model_desc *desc = table;
    fputs("material,alpha_x,alpha_y,roughness1,share1_0,share1_1,share1_2,share1_3,roughness2,"
          "share2_0,share2_1,share2_2,share2_3\n",
          file);
    for (int i = 0; i < desc->material_count; i++) {
        const hnbrdf_material *m = &desc->materials[i];
        hnbrdf_write_csv_text(file, desc->names[i]);
        fprintf(file, ",%.9g,%.9g", (double)m->alpha[0], (double)m->alpha[1]);
        for (int k = 0; k < HNBRDF_LOBES; k++) {
            fprintf(file, ",%.9g", roughness(desc, m, k));
            for (int j = 0; j < HNBRDF_LOBE_KNOTS; j++)
                fprintf(file, ",%.9g", (double)m->lobes.share[k][j]);
        }
        putc('\n', file);
    }
}

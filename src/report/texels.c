/* texels.c: the materials of an export as texels in a file, and what the packing costs. */
#include "report/texels.h"

#include "core/compose.h"
#include "hnbrdf/metrics.h"
#include "report/output.h"

enum { COST_PAIRS = 20000 };

static const hnbrdf_material *material_of(const report_texels *texels, int k)
{
    return hnbrdf_model_material(texels->model, texels->materials[k]);
}

hnbrdf_result texels_write(const report_texels *texels, const char *path, hnbrdf_error *error)
{
    unsigned char row[HNBRDF_MAX_TEXELS * 8];
    size_t size = (size_t)hnbrdf_packing_texels(&texels->packing) *
                  hnbrdf_texel_bytes(texels->packing.format);
    report_output output;
    hnbrdf_result result = report_output_open(path, &output, error);
    if (result != HNBRDF_OK)
        return result;
    const size_t bytes = hnbrdf_texel_bytes(texels->packing.format);
    const size_t part = texels->planes ? bytes : size; /* of a material at a time */
    for (size_t at = 0; at < size; at += part)
        for (int k = 0; k < texels->count; k++) {
            hnbrdf_material_pack(&texels->packing, material_of(texels, k), row);
            fwrite(row + at, 1, part, output.file); /* closing tells whether it failed */
        }
    return report_output_close(&output, error);
}

/* SMAPE of one packed material against itself before, grid sampler. */
static double cost_of(const report_texels *texels, int k)
{
    unsigned char row[HNBRDF_MAX_TEXELS * 8];
    hnbrdf_material packed;
    hnbrdf_material_pack(&texels->packing, material_of(texels, k), row);
    hnbrdf_material_unpack(&texels->packing, row, &packed);
    hnbrdf_rng rng;
    hnbrdf_rng_seed(&rng, 1, 0);
    double sum = 0.0;
    for (int i = 0; i < COST_PAIRS; i++) {
        float wi[3], wo[3], before[3], after[3];
        hnbrdf_sampler_draw(HNBRDF_SAMPLER_GRID, &rng, wi, wo);
        hnbrdf_eval(texels->model, material_of(texels, k), wi, wo, before);
        hnbrdf_eval(texels->model, &packed, wi, wo, after);
        for (int c = 0; c < 3; c++)
            sum += hnbrdf_smape((double)after[c], (double)before[c]);
    }
    return sum / (3.0 * COST_PAIRS);
}

static int is_anisotropic(const hnbrdf_material *material)
{
    return material->alpha[0] != material->alpha[1];
}

static int is_rotated(const hnbrdf_material *material)
{
    return material->rotation != 0.0f;
}

static int conserves_energy(const hnbrdf_material *material)
{
    return hnbrdf_has_energy(&material->energy);
}

/* "field (of which there is MATERIAL)", the first one that asks for it. */
static void print_field(const report_texels *texels, int stored, const char *field,
                        int (*asks)(const hnbrdf_material *material), FILE *file)
{
    if (!stored)
        return;
    for (int k = 0; k < texels->count; k++)
        if (asks && asks(material_of(texels, k))) {
            fprintf(file, ", %s (%s has it)", field,
                    hnbrdf_model_material_name(texels->model, texels->materials[k]));
            return;
        }
    fprintf(file, ", %s", field);
}

/* What is stored, as one material alone may add to the texels of all. */
static void print_fields(const report_texels *texels, FILE *file)
{
    const hnbrdf_packing *packing = &texels->packing;
    fprintf(file, "fields: %s", packing->analytic ? "kd, eta, alpha" : "no analytic part");
    print_field(texels, packing->analytic && packing->anisotropic, "a second alpha", is_anisotropic,
                file);
    print_field(texels, packing->rotated, "rotation", is_rotated, file);
    print_field(texels, packing->analytic && packing->edited, "what it was fitted with",
                hnbrdf_material_is_edited, file);
    if (packing->latent > 0)
        fprintf(file, ", %d latent", packing->latent);
    print_field(texels, packing->lobes, "lobes", NULL, file);
    print_field(texels, packing->energy, "energy", conserves_energy, file);
    fprintf(file, "\n");
}

void texels_print_cost(const report_texels *texels, const report_watch *watch, FILE *file)
{
    double sum = 0.0, worst = 0.0;
    int worst_at = 0, count = hnbrdf_packing_texels(&texels->packing);
    for (int k = 0; k < texels->count; k++) {
        double cost = cost_of(texels, k);
        sum += cost;
        if (cost > worst) {
            worst = cost;
            worst_at = k;
        }
        report_show(watch, (k + 1.0) / texels->count, "");
    }
    fprintf(file, "packed: %d texel%s a material, %s, %d bytes\n", count, count == 1 ? "" : "s",
            texels->packing.format == HNBRDF_TEXEL_RGBA16F ? "RGBA16F" : "RGBA8",
            count * (int)hnbrdf_texel_bytes(texels->packing.format));
    print_fields(texels, file);
    fprintf(
        file,
        "SMAPE between packed and original: mean %.5f, worst %.5f (%s), grid, %d pairs, seed 1\n",
        sum / texels->count, worst,
        hnbrdf_model_material_name(texels->model, texels->materials[worst_at]), COST_PAIRS);
}

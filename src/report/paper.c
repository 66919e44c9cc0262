/* paper.c: the figures that De Oliveira et al. (EGSR 2026) print, and the materials that they are
 * of. */
#include "report/paper.h"

#include <stdlib.h>
#include <string.h>

const double hnbrdf_paper_ggx_smape[PAPER_DATABASES] = {0.36, 0.64, 0.19};
const double hnbrdf_paper_ggx_psnr[PAPER_DATABASES] = {32.89, 33.51, 32.58};
const int hnbrdf_paper_materials[PAPER_DATABASES] = {100, 62, 150};
const char *const hnbrdf_paper_names[PAPER_DATABASES] = {"MERL", "RGL", "UTIA"};

/* Hybrid with l = 4, then neural with l = 12; MERL, RGL, UTIA. */
const paper_row hnbrdf_paper_rows[PAPER_NETS] = {
    {{16, 2}, {{0.2815, 0.6006}, {0.6184, 0.7552}, {0.0958, 0.1173}}, {{0}}},
    {{16, 3},
     {{0.2389, 0.3890}, {0.6095, 0.6669}, {0.0913, 0.1139}},
     {{39.37, 35.75}, {35.54, 34.78}, {38.17, 36.43}}},
    {{32, 2}, {{0.2470, 0.3524}, {0.5899, 0.6293}, {0.0778, 0.1046}}, {{0}}},
    {{32, 3},
     {{0.2003, 0.2537}, {0.5687, 0.6549}, {0.0677, 0.0833}},
     {{40.50, 38.79}, {37.54, 36.06}, {38.90, 38.35}}},
    {{64, 2}, {{0.2174, 0.2681}, {0.5925, 0.5942}, {0.0634, 0.0878}}, {{0}}},
    {{64, 3},
     {{0.1800, 0.2085}, {0.5100, 0.5376}, {0.0483, 0.0657}},
     {{41.19, 40.71}, {39.18, 39.43}, {39.62, 39.12}}},
};

/* The materials of RGL that networks were published for; in byte order. */
static const char *const RGL[] = {
    "acrylic_felt_green",
    "acrylic_felt_orange",
    "acrylic_felt_pink",
    "acrylic_felt_purple",
    "acrylic_felt_white",
    "acrylic_felt_yellow",
    "aniso_brushed_aluminium_1",
    "aniso_copper_sheet",
    "aniso_green_pvc",
    "aniso_metallic_paper_copper",
    "aniso_metallic_paper_gold",
    "aniso_miro_7",
    "aniso_morpho_melenaus",
    "aniso_sari_silk_2color",
    "aurora_white",
    "cardboard",
    "cc_amber_citrine",
    "cc_blue_agat",
    "cc_green_malachite",
    "cc_ibiza_sunset",
    "cc_iris_purple_gem",
    "cc_nothern_aurora",
    "cg_sunflower",
    "chm_light_blue",
    "chm_mint",
    "chm_orange",
    "cm_military_green",
    "cm_toxic_green",
    "cm_white",
    "colodur_azure_4e",
    "colodur_connemara_4c",
    "colodur_kalahari_2a",
    "colodur_napoli_4f",
    "ilm_aniso_darth_vader_pants",
    "ilm_aniso_tarkin_tunic",
    "ilm_l3_37_dark_green",
    "ilm_l3_37_matte",
    "ilm_l3_37_metallic",
    "ilm_solo_m_68",
    "ilm_solo_millennium_falcon",
    "irid_flake_paint1",
    "irid_flake_paint1_fine",
    "irid_flake_paint2",
    "laika_ceiling_paint_18_gray",
    "leaf_maple",
    "paper_blue",
    "paper_green",
    "paper_red",
    "paper_white",
    "paper_yellow",
    "satin_blue",
    "satin_gold",
    "satin_purple",
    "satin_rosaline",
    "satin_white",
    "spectralon",
    "vch_dragon_eye_red",
    "vch_frozen_amethyst",
    "vch_golden_yellow",
    "vch_silk_blue",
    "vch_ultra_pink",
    "weta_brushed_steel_satin_pink",
};

const paper_row *paper_find(const int net[2])
{
    for (int k = 0; k < PAPER_NETS; k++)
        if (hnbrdf_paper_rows[k].net[0] == net[0] && hnbrdf_paper_rows[k].net[1] == net[1])
            return &hnbrdf_paper_rows[k];
    return NULL;
}

/* ---- Whose data ------------------------------------------------------------------------------ */

static int compare_names(const void *name, const void *entry)
{
    return strcmp((const char *)name, *(const char *const *)entry);
}

static int is_rgl(const char *name)
{
    return bsearch(name, RGL, sizeof RGL / sizeof RGL[0], sizeof RGL[0], compare_names) != NULL;
}

/* m001_ to m150_ */
static int is_utia(const char *name)
{
    int number = 0;
    if (name[0] != 'm' || strspn(name + 1, "0123456789") != 3 || name[4] != '_')
        return 0;
    for (int k = 1; k <= 3; k++)
        number = 10 * number + name[k] - '0';
    return number >= 1 && number <= hnbrdf_paper_materials[PAPER_UTIA];
}

int paper_database_of(const hnbrdf_measured *measured)
{
    const char *name = hnbrdf_measured_name(measured);
    const hnbrdf_measured_format format = hnbrdf_measured_format_of(measured);
    if (hnbrdf_measured_published(measured))
        return PAPER_MERL;
    if (format == HNBRDF_MEASURED_RGL && is_rgl(name))
        return PAPER_RGL;
    return format == HNBRDF_MEASURED_UTIA && is_utia(name) ? PAPER_UTIA : -1;
}

/* ---- Tables ---------------------------------------------------------------------------------- */

static void write_heading(FILE *file, const double ggx[PAPER_DATABASES])
{
    fputs("| net |", file);
    for (int d = 0; d < PAPER_DATABASES; d++)
        fprintf(file, " %s hybrid l=%d | neural l=%d |", hnbrdf_paper_names[d],
                (int)PAPER_HYBRID_LATENT, (int)PAPER_NEURAL_LATENT);
    fputs("\n|---|---|---|---|---|---|---|\n| GGX alone |", file);
    for (int d = 0; d < PAPER_DATABASES; d++)
        fprintf(file, " %.2f | |", ggx[d]);
    putc('\n', file);
}

static void write_rows(FILE *file, int psnr)
{
    for (int k = 0; k < PAPER_NETS; k++) {
        const paper_row *row = &hnbrdf_paper_rows[k];
        const double(*values)[PAPER_MODELS] = psnr ? row->psnr : row->smape;
        if (values[0][0] == 0.0)
            continue;
        fprintf(file, "| %dx%d |", row->net[0], row->net[1]);
        for (int d = 0; d < PAPER_DATABASES; d++)
            for (int m = 0; m < PAPER_MODELS; m++)
                fprintf(file, psnr ? " %.2f |" : " %.4f |", values[d][m]);
        putc('\n', file);
    }
}

void paper_write_smape(FILE *file)
{
    fputs("Mean SMAPE as published (De Oliveira et al., EGSR 2026): the MERL, RGL and UTIA "
          "databases,\nsampler unknown.\n\n",
          file);
    write_heading(file, hnbrdf_paper_ggx_smape);
    write_rows(file, 0);
}

void paper_write_psnr(FILE *file)
{
    fputs("\nMean image PSNR as published (512 x 512, 1024 samples a pixel, the Uffizi probe):\n\n",
          file);
    write_heading(file, hnbrdf_paper_ggx_psnr);
    write_rows(file, 1);
}

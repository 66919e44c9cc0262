/* paper.h: what the paper prints, and which data it prints that of. */
#ifndef HNBRDF_REPORT_PAPER_H
#define HNBRDF_REPORT_PAPER_H

#include "hnbrdf/measured.h"

#include <stdio.h>

/* The databases of De Oliveira et al. (EGSR 2026). */
typedef enum paper_database {
    PAPER_MERL = 0,
    PAPER_RGL,
    PAPER_UTIA,
    PAPER_DATABASES
} paper_database;

typedef enum paper_model { PAPER_HYBRID = 0, PAPER_NEURAL, PAPER_MODELS } paper_model;
enum { PAPER_HYBRID_LATENT = 4, PAPER_NEURAL_LATENT = 12, PAPER_NETS = 6 };

/* The figures of one size of network; psnr is 0 where none is printed. */
typedef struct paper_row {
    int net[2];
    double smape[PAPER_DATABASES][PAPER_MODELS], psnr[PAPER_DATABASES][PAPER_MODELS];
} paper_row;

extern const paper_row hnbrdf_paper_rows[PAPER_NETS];
/* Of GGX alone; how many materials each database has, and its name. */
extern const double hnbrdf_paper_ggx_smape[PAPER_DATABASES], hnbrdf_paper_ggx_psnr[PAPER_DATABASES];
extern const int hnbrdf_paper_materials[PAPER_DATABASES];
extern const char *const hnbrdf_paper_names[PAPER_DATABASES];

/* The row of a network, or NULL. */
const paper_row *paper_find(const int net[2]);

/* The database that a material is of, or -1. MERL: its file is the published one, to the last bit,
 * where it was opened with merl_identify. RGL: one of the paper's 62 names; UTIA: m001_ to m150_
 * before a name, and the format; the contents of both are not known here. */
int paper_database_of(const hnbrdf_measured *measured);

/* Markdown, all databases: SMAPE; PSNR. */
void paper_write_smape(FILE *file);
void paper_write_psnr(FILE *file);

#endif

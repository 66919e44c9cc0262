/* builtin.h: what a built-in procedural material is. */
#ifndef HNBRDF_MEASURED_BUILTIN_H
#define HNBRDF_MEASURED_BUILTIN_H

/* A film of index n and thickness in nm, seen from a medium of index outside_n, on a base of index
 * base_n - i base_k; all constant over the visible spectrum. Several such plates may lie in a pile,
 * farther apart than light interferes. */
typedef struct film_stack {
    double outside_n, n, thickness, base_n, base_k;
    int plates;
} film_stack;

/* Its reflectance as linear RGB over the cosine of incidence: entry k at k / FILM_STEPS. */
enum { FILM_STEPS = 256 };
typedef struct film_table {
    double rgb[FILM_STEPS + 1][3];
} film_table;

/* Two directions above the horizon and their half vector, in the frame of a lobe. */
typedef struct pair {
    double wi[3], wo[3];
    double h[3]; /* unit */
    double c;    /* wi.h = wo.h */
    /* of the material that is evaluated; only set on the pair it is given */
    const film_table *film;
} pair;

typedef struct builtin_material {
    const char *name;
    const char *about;
    int isotropic;
    const film_stack *film; /* or NULL */
    void (*eval)(const pair *p, double f[3]);
} builtin_material;

extern const builtin_material hnbrdf_builtin_materials[], hnbrdf_builtin_anisotropic[];
extern const int hnbrdf_builtin_material_count, hnbrdf_builtin_anisotropic_count;

/* Of both sets, the anisotropic one behind the other; NULL when index is out of range. */
const builtin_material *hnbrdf_builtin_at(int index);

void hnbrdf_film_fill(film_table *table, const film_stack *film);
void hnbrdf_film_reflectance(const film_table *table, double c, double rgb[3]);

#endif

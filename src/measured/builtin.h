/* builtin.h: what the built-in procedural materials are made of. All in double precision; every term is
 * unchanged to the last bit when wi and wo swap. */
#ifndef HNBRDF_MEASURED_BUILTIN_H
#define HNBRDF_MEASURED_BUILTIN_H

#define COAT_ETA 1.5 /* index of every coat */

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
    double h[3];            /* unit */
    double c;               /* wi.h = wo.h */
    const film_table *film; /* of the material that is evaluated; only set on the pair it is given */
} pair;

typedef struct builtin_material {
    const char *name;
    const char *about;
    int isotropic;
    const film_stack *film; /* or NULL */
    void (*eval)(const pair *p, double f[3]);
} builtin_material;

extern const builtin_material hnbrdf_builtin_materials[];
extern const int hnbrdf_builtin_material_count;

/* builtin_terms.c */
pair make_pair(const double wi[3], const double wo[3]);
/* The same directions with the tangent turned by angle radians about n. */
pair turned_pair(const pair *p, double angle);
/* The same directions after refraction into a medium of this index. */
pair refracted_pair(const pair *p, double eta);
/* wi mirrored about n: lobes around the mirror direction become lobes around the light. */
pair retro_pair(const pair *p);

double ggx(const pair *p, double alpha_x, double alpha_y);
double fresnel_dielectric(double eta, double c);
double fresnel_conductor(double n, double k, double c);
double schlick(double f0, double c);
double coat_transmission(const pair *p);
double diffuse_under_coat(const pair *p, double albedo);
double oren_nayar(const pair *p, double roughness);
double charlie_sheen(const pair *p, double roughness);
double lafortune(const pair *p, double z_weight, double exponent);
double hapke(const pair *p, double albedo, double surge, double width, double asymmetry);

/* builtin_film.c */
void film_fill(film_table *table, const film_stack *film);
void film_reflectance(const film_table *table, double c, double rgb[3]);

#endif

/* describe.h: a scene as text, line by line, and the scene that it describes.
 *
 * One statement a line, words apart by blanks, "in quotes" where a word has blanks itself; #
 * begins a comment. Lengths are in one unit throughout, y is up, angles in degrees, colours
 * linear. [] may be left out.
 *
 *   camera from X Y Z to X Y Z fov DEG [up X Y Z] [lens RADIUS] [focus DISTANCE]
 *   size WIDTH HEIGHT              of the picture
 *   exposure EV                    of the PNG
 *   bounces N                      most reflections of a path
 *   environment SOURCE [rotate DEG] [gain G] [hidden]     sky, furnace, or a map; hidden: not
 *               [layer NAME] [repair]                     behind the shapes; a layer of an
 *                                                         OpenEXR map, and pixels that are not
 *                                                         finite filled
 *   portal corner X Y Z edge X Y Z edge X Y Z             a window through which the environment
 *                                                         is seen
 *   material NAME model FILE [MATERIAL]                   of a model file
 *   material NAME measured FILE
 *   material NAME builtin NAME
 *   material NAME ggx kd R G B eta R G B alpha A [ALPHA_Y]
 *   material NAME diffuse R G B                           Lambert
 * shape KIND [its parameters] [material NAME] [emit R G B] [placing]
 *
 * Kinds of shapes and their parameters, detail N being the quads around:
 *   sphere; quad; box; torus [tube R]; knot [turns P Q] [tube R]; superellipsoid [powers E1 E2];
 * teapot; lathe profile R Y R Y ...; obj FILE [use PART MATERIAL]... [smooth] Placing, in the order
 * given: scale S, stretch X Y Z, turn DEG (about y), rotate X Y Z DEG (about an axis), move X Y Z.
 * Files are looked for beside the scene. Both sides of a surface reflect; its outside emits.
 * Shapes end up within RENDER_FAR of the origin. UTF-8, perhaps behind a byte-order mark. */
#ifndef HNBRDF_SCENE_DESCRIBE_H
#define HNBRDF_SCENE_DESCRIBE_H

#include "scene/scene.h"
#include "scene/shapes.h"

enum { RENDER_MAX_PATH = 1024, RENDER_MAX_USES = 32, RENDER_MAX_TEXT = 4 << 20 };

typedef enum render_material_source {
    RENDER_FROM_MODEL,
    RENDER_FROM_MEASURED,
    RENDER_FROM_BUILTIN,
    RENDER_FROM_GGX
} render_material_source;

typedef struct render_text_material {
    char name[HNBRDF_MAX_NAME + 1];
    long line;
    render_material_source source;
    char file[RENDER_MAX_PATH];      /* model, measured */
    char which[HNBRDF_MAX_NAME + 1]; /* of the model, "" for its only one; or the built-in one */
    hnbrdf_material ggx;
} render_text_material;

typedef struct render_text_shape {
    long line;
    render_shape_kind kind;
    render_shape_options options;
    char file[RENDER_MAX_PATH]; /* obj */
    int smooth;
    int material; /* number of it, -1: none */
    float emission[3];
    render_transform place;
    struct {
        char part[HNBRDF_MAX_NAME + 1];
        int material;
    } uses[RENDER_MAX_USES];
    int use_count;
} render_text_shape;

typedef struct render_description {
    char name[RENDER_MAX_PATH]; /* of the file, for messages and for files beside it */
    render_text_material *materials;
    int material_count;
    render_text_shape *shapes;
    int shape_count;
    render_portal portals[RENDER_MAX_PORTALS];
    int portal_count;
    char environment[RENDER_MAX_PATH]; /* "": none */
    long environment_line;
    char environment_layer[RENDER_MAX_PATH]; /* "": not given */
    int environment_repair;
    double rotate, gain;
    int hidden;
    render_camera camera; /* width 0: no size given */
    int bounces;          /* 0: not given */
    double exposure;      /* NAN: not given */
} render_description;

/* Opens no other file. At most 4 MiB of text. */
hnbrdf_result render_description_parse(const void *data, size_t size, const char *name,
                                       render_description *description, hnbrdf_error *error);
hnbrdf_result render_description_read(const char *path, render_description *description,
                                      hnbrdf_error *error);
void render_description_free(render_description *description);
/* A file that it names: beside the scene, unless its path is absolute. */
void render_description_path(const render_description *description, const char *file,
                             char path[2 * RENDER_MAX_PATH]);

/* What the materials from models are shown as. */
typedef enum render_show {
    RENDER_SHOW_MODEL = 0,
    RENDER_SHOW_ANALYTIC, /* their GGX part alone */
    RENDER_SHOW_MEASURED  /* the measurement of the same name, from a folder */
} render_show;

/* A scene with all that it borrows. */
typedef struct render_loaded {
    render_scene scene;
    render_environment environment;
    hnbrdf_model **models; /* one a file; the first is that of guides and plain GGX */
    int model_count;
    hnbrdf_measured **measured;
    int measured_count;
} render_loaded;

/* How the files of a scene are read. Zero-initialise for defaults. */
typedef struct render_reading {
    const hnbrdf_measured_options *measured; /* NULL: the defaults */
    hnbrdf_notes notes; /* told of what models, meshes and pictures needed, and shapes too small */
} render_reading;

/* Reads all files and builds the scene. `folder`: for RENDER_SHOW_MEASURED, holds each
 * NAME or NAME_rgb with the ending of a measured format. reading may be NULL. */
hnbrdf_result render_description_load(const render_description *description, render_show show,
                                      const char *folder, const render_reading *reading,
                                      render_loaded *loaded, hnbrdf_error *error);
void render_loaded_free(render_loaded *loaded);

#endif

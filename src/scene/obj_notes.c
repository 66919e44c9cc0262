/* obj_notes.c: what was computed or left aside of an OBJ file, a line for each kind. */
#include "scene/obj_reader.h"

#include "base/error.h"

#include <string.h>

void obj_count(obj_tally *tally, const obj_lines *in, const char *found, int length)
{
    if (tally->count++ > 0)
        return;
    const int room = (int)sizeof tally->found - 1;
    tally->line = in->line;
    memcpy(tally->found, found, (size_t)(length < room ? length : room));
}

void obj_tell(const obj_tally tallies[OBJ_NOTES], const char *name, const hnbrdf_notes *notes)
{
    static const struct {
        const char *before, *behind; /* what was found */
        const char *unit, *units;    /* of the count */
        const char *outcome;
    } kinds[OBJ_NOTES] = {
        [OBJ_NORMAL_ABSENT] = {"normal '", "' of a face is not in the file", "face", "faces",
                               "drawn with the normals of their planes"},
        [OBJ_NORMAL_WITHOUT] = {"a face without normals, which others have", "", "face", "faces",
                                "drawn with the normals of their planes"},
        [OBJ_NORMAL_UNUSABLE] = {"vn: found '", "', expected a direction", "line", "lines",
                                 "faces with it are drawn with the normals of their planes"},
        [OBJ_UV_ABSENT] = {"texture coordinate '", "' of a face is not in the file", "face",
                           "faces", "drawn without"},
        [OBJ_UV_WITHOUT] = {"a face without texture coordinates, which others have", "", "face",
                            "faces", "drawn without"},
        [OBJ_UV_UNUSABLE] = {"vt: found '", "', expected finite numbers", "line", "lines",
                             "faces with it are drawn without texture coordinates"},
        [OBJ_FACE_SHORT] = {"a face of fewer than 3 corners", "", "face", "faces", "skipped"},
        [OBJ_LINES] = {"'", "': lines and points are no surface", "statement", "statements",
                       "not drawn"},
        [OBJ_FREE_FORM] = {"'", "': curves and free-form surfaces are not read", "statement",
                           "statements", "not drawn"},
        [OBJ_UNKNOWN] = {"'", "' is no statement of OBJ files", "line", "lines", "passed over"},
    };
    for (int k = 0; k < OBJ_NOTES; k++) {
        const obj_tally *t = &tallies[k];
        if (t->count)
            hnbrdf_note(notes, "%s:%ld: %s%s%s (%zu %s): %s", name, t->line, kinds[k].before,
                        t->found, kinds[k].behind, t->count,
                        t->count == 1 ? kinds[k].unit : kinds[k].units, kinds[k].outcome);
    }
}

/* translate.c: the steps of a translation. */
#include "language/translation.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/printer.h"
#include "language/parse.h"
#include "language/preprocess.h"
#include "language/print.h"

static int discard(void *user, const void *data, size_t size)
{
    (void)user;
    (void)data;
    (void)size;
    return 0;
}

/* Printed twice: the first time nothing is written, so that what is refused leaves no half text. */
static void print_texts(hnbrdf_translation *t, const hnbrdf_node *texts, hnbrdf_write_fn write,
                        void *user)
{
    hnbrdf_printer out = {.write = write, .user = user};
    hnbrdf_print p = {.t = t, .dialect = t->dialect, .out = &out};
    for (int k = 0; k < t->count; k++) {
        p.source = &t->sources[k];
        if (p.source->print)
            hnbrdf_print_text(&p, texts);
        texts = texts->next;
    }
    hnbrdf_put_flush(&out);
    if (out.failed && !t->result)
        t->result = hnbrdf_fail(t->error, HNBRDF_ERROR_IO, "writing the translated text failed");
}

static void parse_and_print(hnbrdf_translation *t, hnbrdf_node **names, hnbrdf_write_fn write,
                            void *user)
{
    hnbrdf_parser parser = {.t = t, .names = names};
    hnbrdf_node all = {.kind = HNBRDF_NODE_TEXT};
    for (int k = 0; k < t->count && !t->result; k++)
        hnbrdf_add_child(&all, hnbrdf_parse_text(&parser));
    if (!t->result)
        print_texts(t, all.first, discard, NULL);
    if (!t->result)
        print_texts(t, all.first, write, user);
}

hnbrdf_result hnbrdf_translate(const hnbrdf_source *sources, int count,
                               const hnbrdf_dialect *dialect, int exact,
                               const hnbrdf_allocator *memory, hnbrdf_write_fn write, void *user,
                               hnbrdf_error *error)
{
    hnbrdf_translation t = {.sources = sources,
                            .count = count,
                            .dialect = dialect,
                            .exact = exact,
                            .memory = memory,
                            .error = error};
    hnbrdf_preprocess(&t);
    hnbrdf_node **names = NULL;
    if (!t.result) {
        t.node_room = t.tokens.count + 1;
        t.nodes = (hnbrdf_node *)hnbrdf_allocate(memory, t.node_room * sizeof *t.nodes);
        if (!t.nodes)
            hnbrdf_refuse_memory(&t, t.node_room * sizeof *t.nodes);
    }
    if (!t.result) {
        names = (hnbrdf_node **)hnbrdf_allocate(memory, t.node_room * sizeof(hnbrdf_node *));
        if (!names)
            hnbrdf_refuse_memory(&t, t.node_room * sizeof(hnbrdf_node *));
    }
    if (!t.result)
        parse_and_print(&t, names, write, user);
    hnbrdf_release(memory, names);
    hnbrdf_release(memory, t.nodes);
    hnbrdf_release(memory, t.tokens.list);
    return t.result;
}

/* mutant.h: included before every source in the copies of mutants.sh: which of the changes built in
 * is made. Each macro is a comparison with its change: at the edge, or the whole negated. */
#ifndef HNBRDF_TESTS_MUTANT_H
#define HNBRDF_TESTS_MUTANT_H

extern int hnbrdf_mutant;

#define MUTANT_SWITCH(a, op, changed, b, id) (hnbrdf_mutant == (id) ? (a)changed(b) : (a)op(b))
#define MUTANT_LT_EDGE(a, b, id) MUTANT_SWITCH(a, <, <=, b, id)
#define MUTANT_LT_NOT(a, b, id) MUTANT_SWITCH(a, <, >=, b, id)
#define MUTANT_GT_EDGE(a, b, id) MUTANT_SWITCH(a, >, >=, b, id)
#define MUTANT_GT_NOT(a, b, id) MUTANT_SWITCH(a, >, <=, b, id)
#define MUTANT_LE_EDGE(a, b, id) MUTANT_SWITCH(a, <=, <, b, id)
#define MUTANT_GE_EDGE(a, b, id) MUTANT_SWITCH(a, >=, >, b, id)
#define MUTANT_EQ_NOT(a, b, id) MUTANT_SWITCH(a, ==, !=, b, id)
#define MUTANT_NE_NOT(a, b, id) MUTANT_SWITCH(a, !=, ==, b, id)
/* a * b becomes a * (1 / b). */
#define MUTANT_INVERSE(x, id) (hnbrdf_mutant == (id) ? 1 / (x) : (x))

#endif

/* csv.h: the names that commands have for base/csv.h and base/write.h. */
#ifndef HNBRDF_CLI_CSV_H
#define HNBRDF_CLI_CSV_H

#include "base/csv.h"
#include "base/write.h"

#define csv_write_text hnbrdf_write_csv_text

#endif

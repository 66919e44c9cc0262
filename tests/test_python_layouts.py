"""test_python_layouts.py INCLUDE: prints a C file of assertions that the layouts and enums of
examples/python/hnbrdf are those of the headers, and checks the functions against their declarations:
as many parameters, pointers for pointers, numbers of the same size."""
import ctypes as c
import pathlib
import re
import sys

import numpy as np

from hnbrdf import layouts, library

HEADERS = sorted(pathlib.Path(sys.argv[1], "hnbrdf").glob("*.h"))


def say(condition: str, about: str) -> None:
    print(f'_Static_assert({condition}, "{about}");')


def structure(kind: type) -> None:
    name = kind.__name__
    say(f"sizeof({name}) == {c.sizeof(kind)}", name)
    for field, part in kind._fields_:
        say(f"offsetof({name}, {field}) == {getattr(kind, field).offset}", f"{name}.{field}")
        say(f"sizeof((({name} *)0)->{field}) == {c.sizeof(part)}", f"{name}.{field}")


def record(name: str, dtype: np.dtype, path: str = "", base: int = 0) -> None:
    for field, (part, offset, *_) in dtype.fields.items():
        place = path + field
        say(f"offsetof({name}, {place}) == {base + offset}", f"{name}.{place}")
        say(f"sizeof((({name} *)0)->{place}) == {part.itemsize}", f"{name}.{place}")
        if part.fields:
            record(name, part, place + ".", base + offset)
    if not path:
        say(f"sizeof({name}) == {dtype.itemsize}", name)


def same(declared: str, kind) -> bool:
    declared = declared.strip()
    if "*" in declared or "[" in declared or re.search(r"_fn\b", declared):
        return kind in (c.c_void_p, c.c_char_p) or issubclass(kind, c._CFuncPtr)
    word = re.sub(r"\bconst\b", "", declared).split()[0]
    sizes = {"size_t": c.c_size_t, "uint64_t": c.c_uint64, "float": c.c_float, "double": c.c_double}
    return kind is sizes.get(word, c.c_int)  # int, and enums


def function(text: str, name: str, result, arguments) -> bool:
    found = re.search(r"(?:HNBRDF_API|HNBRDF_EXPERIMENTAL)\s+([\w\s*]+?)\b" + name + r"\(([^;]*)\);", text)
    if not found:
        print(f"{name}: no such function in the headers", file=sys.stderr)
        return False
    declared = [] if found[2].strip() == "void" else found[2].split(",")
    good = found[1].strip() == "void" if result is None else same(found[1], result)
    if good and len(declared) == len(arguments) and all(map(same, declared, arguments)):
        return True
    print(f"{name}: declared as {' '.join(found[0].split())}", file=sys.stderr)
    return False


print("#include <stddef.h>")
for header in HEADERS:
    print(f"#include <hnbrdf/{header.name}>")
for kind in vars(layouts).values():
    if isinstance(kind, type) and issubclass(kind, c.Structure) and kind is not c.Structure:
        structure(kind)
record("hnbrdf_material", layouts.material_dtype)
record("hnbrdf_sample_result", layouts.sample_dtype)
for prefix, names in layouts.ENUMS.values():
    for value, name in enumerate(names.split()):
        say(f"{value} == {prefix}{name}", prefix + name)
for value in library.Result:
    name = "HNBRDF_OK" if value == 0 else f"HNBRDF_ERROR_{value.name}"
    say(f"{int(value)} == {name}", name)
for name, value in (("MAX_LATENT", layouts.MAX_LATENT), ("MAX_LAYERS", layouts.MAX_LAYERS),
                    ("MIX_KNOTS", layouts.MIX_KNOTS)):
    say(f"HNBRDF_{name} == {value}", name)

text = "".join(header.read_text() for header in HEADERS)
text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
bad = [name for functions in library.FUNCTIONS.values()
       for name, (result, *arguments) in functions.items()
       if not function(text, "hnbrdf_" + name, result, arguments)]
sys.exit(bool(bad))

/* direct3d.c: direct3d DLL PROFILE FILE...: compiles HLSL with Direct3D's own compilers, for
 * Windows or wine: d3dcompiler_47.dll (FXC, profiles up to 5_1) or dxcompiler.dll (DXC, from 6_0
 * on). The entry point is main. Prints a line a file: its name, milliseconds of processor time,
 * bytes of the result, or what the compiler said; warnings follow. Exit status 1 if one does not
 * compile, 2 if the DLL is no use. */
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- What both DLLs give: a blob, and the first methods of any object ------------------------ */

typedef struct blob blob;
struct blob {
    struct {
        HRESULT(WINAPI *query)(blob *, const GUID *, void **);
        ULONG(WINAPI *add)(blob *);
        ULONG(WINAPI *release)(blob *);
        void *(WINAPI *pointer)(blob *);
        SIZE_T(WINAPI *size)(blob *);
    } const *methods;
};

typedef struct outcome {
    HRESULT status;
    size_t bytes;
    char messages[4096];
} outcome;

static void take_messages(blob *b, outcome *found)
{
    if (!b)
        return;
    size_t size = b->methods->size(b);
    size = size < sizeof found->messages ? size : sizeof found->messages - 1;
    memcpy(found->messages, b->methods->pointer(b), size);
    found->messages[size] = '\0';
    b->methods->release(b);
}

static void take_code(blob *b, outcome *found)
{
    if (!b)
        return;
    found->bytes = b->methods->size(b);
    b->methods->release(b);
}

/* ---- FXC ------------------------------------------------------------------------------------- */

typedef HRESULT(WINAPI *d3d_compile)(const void *, SIZE_T, const char *, const void *, void *,
                                     const char *, const char *, UINT, UINT, blob **, blob **);

static void compile_fxc(FARPROC function, const char *profile, const char *text, outcome *found)
{
    blob *code = NULL, *messages = NULL;
    d3d_compile compile;
    memcpy(&compile, &function, sizeof compile);
    found->status =
        compile(text, strlen(text), NULL, NULL, NULL, "main", profile, 0, 0, &code, &messages);
    take_code(code, found);
    take_messages(messages, found);
}

/* ---- DXC (dxcapi.h) -------------------------------------------------------------------------- */

typedef struct source {
    const void *bytes;
    SIZE_T size;
    UINT encoding;
} source;

typedef struct result result;
struct result {
    struct {
        HRESULT(WINAPI *query)(result *, const GUID *, void **);
        ULONG(WINAPI *add)(result *);
        ULONG(WINAPI *release)(result *);
        HRESULT(WINAPI *status)(result *, HRESULT *);
        HRESULT(WINAPI *code)(result *, blob **);
        HRESULT(WINAPI *messages)(result *, blob **);
    } const *methods;
};

typedef struct compiler compiler;
struct compiler {
    struct {
        HRESULT(WINAPI *query)(compiler *, const GUID *, void **);
        ULONG(WINAPI *add)(compiler *);
        ULONG(WINAPI *release)(compiler *);
        HRESULT(WINAPI *compile)
        (compiler *, const source *, const WCHAR **, UINT, void *, const GUID *, void **);
    } const *methods;
};

typedef HRESULT(WINAPI *dxc_create)(const GUID *, const GUID *, void **);

static const GUID class_compiler = {
    0x73e22d93, 0xe6ce, 0x47f3, {0xb5, 0xbf, 0xf0, 0x66, 0x4f, 0x39, 0xc1, 0xb0}};
static const GUID interface_compiler = {
    0x228b4687, 0x5a6a, 0x4730, {0x90, 0x0c, 0x97, 0x02, 0xb2, 0x20, 0x3f, 0x54}};
static const GUID interface_result = {
    0x58346cda, 0xdde7, 0x4497, {0x94, 0x61, 0x6f, 0x87, 0xaf, 0x5e, 0x06, 0x59}};

static void compile_dxc(FARPROC function, const char *profile, const char *text, outcome *found)
{
    enum { UTF8 = 65001 };
    WCHAR wide[16];
    const WCHAR *arguments[] = {L"-E", L"main", L"-T", wide, L"-Vd"}; /* -Vd: no dxil.dll here */
    const source from = {text, strlen(text), UTF8};
    compiler *dxc = NULL;
    result *made = NULL;
    blob *code = NULL, *messages = NULL;
    dxc_create create;
    memcpy(&create, &function, sizeof create);
    mbstowcs(wide, profile, sizeof wide / sizeof wide[0]);
    found->status = create(&class_compiler, &interface_compiler, (void **)&dxc);
    if (FAILED(found->status))
        return;
    found->status =
        dxc->methods->compile(dxc, &from, arguments, 5, NULL, &interface_result, (void **)&made);
    if (SUCCEEDED(found->status)) {
        made->methods->status(made, &found->status);
        made->methods->code(made, &code);
        made->methods->messages(made, &messages);
        take_code(code, found);
        take_messages(messages, found);
        made->methods->release(made);
    }
    dxc->methods->release(dxc);
}

/* ---- The command ----------------------------------------------------------------------------- */

static char *read_text(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END))
        return NULL;
    const long size = ftell(file);
    char *text = size < 0 ? NULL : calloc((size_t)size + 1, 1);
    rewind(file);
    if (text && fread(text, 1, (size_t)size, file) != (size_t)size)
        text[0] = '\0';
    fclose(file);
    return text;
}

/* Of this process so far, in milliseconds. */
static unsigned long processor_time(void)
{
    FILETIME created, ended, kernel, user;
    GetProcessTimes(GetCurrentProcess(), &created, &ended, &kernel, &user);
    const ULONGLONG ticks = ((ULONGLONG)kernel.dwHighDateTime << 32) + kernel.dwLowDateTime +
                            ((ULONGLONG)user.dwHighDateTime << 32) + user.dwLowDateTime;
    return (unsigned long)(ticks / 10000);
}

int main(int count, char **words)
{
    HMODULE library = count > 3 ? LoadLibraryA(words[1]) : NULL;
    FARPROC fxc = library ? GetProcAddress(library, "D3DCompile") : NULL;
    FARPROC dxc = library ? GetProcAddress(library, "DxcCreateInstance") : NULL;
    int failed = 0;
    if (!fxc && !dxc)
        return fprintf(stderr, "usage: direct3d DLL PROFILE FILE...; no compiler in that DLL\n"), 2;
    for (int i = 3; i < count; i++) {
        outcome found = {E_FAIL, 0, ""};
        char *text = read_text(words[i]);
        const unsigned long start = processor_time();
        if (text)
            (fxc ? compile_fxc : compile_dxc)(fxc ? fxc : dxc, words[2], text, &found);
        const unsigned long ms = processor_time() - start;
        printf("%s %s %s: %lu ms, %lu bytes\n%s", FAILED(found.status) ? "FAILED" : "ok", words[2],
               words[i], ms, (unsigned long)found.bytes, found.messages);
        fflush(stdout);
        failed |= FAILED(found.status);
        free(text);
    }
    return failed;
}

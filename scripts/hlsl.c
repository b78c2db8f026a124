// Compiles HLSL files with Microsoft's older compiler (FXC, d3dcompiler_47.dll beside the program), under Windows or wine.
// Usage: hlsl.exe FILE ENTRY ...; prints what was refused, exit code 1 if anything was.
#include <stdio.h>
#include <stdlib.h>
#include <windows.h>

typedef struct Blob Blob;
typedef struct { void *query, *add; ULONG(WINAPI *release)(Blob *); void *(WINAPI *data)(Blob *); SIZE_T(WINAPI *size)(Blob *); } Table;
struct Blob { Table *table; };
typedef HRESULT(WINAPI *Compile)(const void *, SIZE_T, const char *, const void *, void *, const char *, const char *, UINT, UINT, Blob **, Blob **);

int main(int count, char **words) {
    HMODULE library = LoadLibraryA("d3dcompiler_47.dll");
    Compile compile = library ? (Compile)(void *)GetProcAddress(library, "D3DCompile") : NULL;
    if (!compile) { puts("d3dcompiler_47.dll is missing"); return 2; }
    int wrong = 0;
    for (int k = 1; k + 1 < count; k += 2) {
        FILE *file = fopen(words[k], "rb");
        if (!file) { printf("%s: cannot be read\n", words[k]); return 2; }
        fseek(file, 0, SEEK_END);
        long size = ftell(file);
        rewind(file);
        char *text = malloc(size);
        size = (long)fread(text, 1, size, file);
        fclose(file);
        Blob *code = NULL, *said = NULL;
        DWORD start = GetTickCount();
        HRESULT result = compile(text, size, words[k], NULL, NULL, words[k + 1], "cs_5_1", 0, 0, &code, &said);
        printf("%s %s %lu ms\n", FAILED(result) ? "FAIL" : "ok  ", words[k], GetTickCount() - start);
        if (FAILED(result)) {
            wrong = 1;
            if (said) printf("%.600s\n", (char *)said->table->data(said));
        }
        fflush(stdout);
        free(text);
    }
    return wrong;
}

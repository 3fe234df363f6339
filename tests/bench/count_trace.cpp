// Counts instructions in what QEMU tells with "-d exec,nochain,in_asm": each block of them when it is
// translated, and a line whenever it runs. Reads that from standard input and keeps the sum so far as text in
// a file: see turn_instructions.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unordered_map>

int main(int argc, char **argv) {
    if (argc != 2)
        return 2;
    std::FILE *const out = std::fopen(argv[1], "w");
    if (!out)
        return 1;
    std::unordered_map<std::uint64_t, std::uint32_t> sizes; // of the block that begins there
    std::uint32_t *translated = nullptr;
    std::uint64_t sum = 0, lines = 0;
    std::array<char, 4096> line{};
    while (std::fgets(line.data(), int(line.size()), stdin)) {
        if (std::strncmp(line.data(), "Trace ", 6) == 0) {
            const char *const begin = std::strchr(line.data(), '/'); // [base/address/...
            if (!begin)
                return 1;
            sum += sizes[std::strtoull(begin + 1, nullptr, 16)];
        } else if (std::strncmp(line.data(), "IN:", 3) == 0) {
            translated = nullptr;
        } else if (std::strncmp(line.data(), "0x", 2) == 0) {
            if (!translated) {
                translated = &sizes[std::strtoull(line.data(), nullptr, 16)];
                *translated = 0;
            }
            ++*translated;
        }
        if (++lines % 256 == 0) {
            std::rewind(out);
            std::fprintf(out, "%020llu", static_cast<unsigned long long>(sum));
            std::fflush(out);
        }
    }
    return 0;
}

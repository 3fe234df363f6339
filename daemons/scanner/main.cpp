#include "daemons/scanner/Scanner.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::scanner::Scanner>(argc, argv);
}

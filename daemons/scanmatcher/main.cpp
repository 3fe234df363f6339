#include "daemons/scanmatcher/ScanMatcher.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::ScanMatcher>(argc, argv);
}

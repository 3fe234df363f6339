#include "daemons/web/Web.h"

int main(int argc, char **argv) {
    return hermes::runDaemon<hermes::web::Web>(argc, argv);
}

# Namespaces of networks have their names below /run. Where there is no nft, or it may not ask the kernel, its file is not checked.
mount -t tmpfs none /run
mkdir -p /run/lock
nft list ruleset >nft.log 2>&1 || nft() { echo "not checked"; }

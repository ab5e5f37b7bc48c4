#!/usr/bin/env bash
# Runs the steps of the Dockerfile without Docker: RUN, COPY . and WORKDIR, in a fresh Debian 12 that debootstrap makes.
#   packaging/try_dockerfile.sh FOLDER [N]     as root; only the first N RUN steps; FOLDER is kept, and must not exist
set -euo pipefail

top=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
root=${1:?usage: try_dockerfile.sh FOLDER [N]}
n=${2:-1000}
command -v debootstrap >/dev/null || { echo "skipped: no debootstrap" >&2; exit 77; }
[[ ! -e $root ]] || { echo "$root exists" >&2; exit 2; }

debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian
cp /etc/resolv.conf /etc/hosts "$root/etc/"
mount --bind /proc "$root/proc"
trap 'umount "$root/proc"' EXIT

at=/ steps=0
while read -r word rest; do
  case $word in
    COPY) mkdir -p "$root${rest#. }" && git -C "$top" ls-files -z --cached --others --exclude-standard |
            tar -C "$top" --null -T - -c | tar -C "$root${rest#. }" -x ;;
    WORKDIR) at=$rest; mkdir -p "$root$at" ;;
    RUN) ((++steps <= n)) || break
         echo "== step $steps: $rest"
         chroot "$root" /usr/bin/env -i PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin DEBIAN_FRONTEND=noninteractive \
           OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 sh -c "cd $at && $rest" ;;
  esac
done <"$top/packaging/Dockerfile"
echo "== $((steps < n ? steps : n)) steps"

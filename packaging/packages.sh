# To be read by a shell: sets `packages` to the Debian packages that building needs, from their list in the launcher.
packages=$(sed -n '/^packages=(/,/)$/p' sprekk | sed 's/^packages=(//; s/)$//')

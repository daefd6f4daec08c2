#!/bin/sh
# The pages as HTML: scripts/docs_html.sh FOLDER. Needs cmark-gfm (Debian: cmark-gfm).
set -eu
[ $# -eq 1 ] || { echo "usage: scripts/docs_html.sh FOLDER" >&2; exit 2; }
out=$1
root=$(cd "$(dirname "$0")/.." && pwd)
command -v cmark-gfm >/dev/null 2>&1 || { echo "docs_html: cmark-gfm is missing (apt-get install cmark-gfm)" >&2; exit 1; }
mkdir -p "$out"
out=$(cd "$out" && pwd)

style='body{max-width:54rem;margin:2rem auto;padding:0 1rem;font:16px/1.55 sans-serif;color:#1b2430}
pre,code{font:14px/1.45 monospace;background:#f3f5f8}pre{padding:.7rem 1rem;overflow-x:auto}code{padding:.1em .25em}
pre code{padding:0}table{border-collapse:collapse;display:block;overflow-x:auto}
td,th{border:1px solid #ccd4de;padding:.3rem .6rem;text-align:left;vertical-align:top}
img{max-width:100%}a{color:#1d5fae}nav{font-size:14px;margin-bottom:1.5rem}'

# Headings get the names that links to them have: small letters, dashes for blanks, other signs left out.
name_headings() {
  awk '{
    if (match($0, /^<h[1-6]>.*<\/h[1-6]>$/)) {
      level = substr($0, 3, 1)
      name = tolower(substr($0, 5, length($0) - 9))
      gsub(/<[^>]*>/, "", name)
      gsub(/&[a-z]+;/, "", name)
      gsub(/[^a-z0-9 _-]/, "", name)
      gsub(/ /, "-", name)
      if (seen[name]++) name = name "-" (seen[name] - 1)
      print "<h" level " id=\"" name "\">" substr($0, 5)
    } else print
  }'
}

# Links to pages lead to their HTML, links to a folder to the list of its pages.
lead_links() {
  sed -E -e 's/href="([^":]*)\.md(#[^"]*)?"/href="\1.html\2"/g' \
         -e 's#href="docs/(guide|developing)/?"#href="docs/\1/index.html"#g'
}

# page FILE TITLE: standard input as a page; FILE relative to the folder.
page() {
  up=$(dirname "$1" | sed -e 's#^\.$##' -e 's#[^/][^/]*#..#g')
  home=${up:+$up/}README.html
  mkdir -p "$out/$(dirname "$1")"
  {
    printf '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8"/>\n<title>%s</title>\n' "$2"
    printf '<meta name="viewport" content="width=device-width"/>\n<style>\n%s\n</style>\n</head>\n<body>\n' "$style"
    printf '<nav><a href="%s">Palpate</a></nav>\n' "$home"
    cat
    printf '</body>\n</html>\n'
  } >"$out/$1"
}

cd "$root"
pages=$(find docs -name '*.md' | LC_ALL=C sort)
for file in README.md CHANGELOG.md CONTRIBUTING.md $pages; do
  title=$(sed -n 's/^# //p' "$file" | head -n 1 | sed -e 's/&/\&amp;/g' -e 's/</\&lt;/g' -e 's/`//g')
  cmark-gfm -e table -e strikethrough "$file" | name_headings | lead_links | page "${file%.md}.html" "$title"
done
for folder in guide developing; do
  {
    printf '<ul>\n'
    for file in docs/"$folder"/*.md; do
      title=$(sed -n 's/^# //p' "$file" | head -n 1 | sed -e 's/&/\&amp;/g' -e 's/</\&lt;/g' -e 's/`//g')
      printf '<li><a href="%s.html">%s</a></li>\n' "$(basename "$file" .md)" "$title"
    done
    printf '</ul>\n'
  } | page "docs/$folder/index.html" "$folder"
done
# What the pages show and name.
find docs -type f ! -name '*.md' | while read -r file; do
  mkdir -p "$out/$(dirname "$file")"
  cp "$file" "$out/$file"
done

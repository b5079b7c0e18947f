// dist/unzstd.js is fzstd (MIT), which tools/build_web.sh copies there with its licence: a page with a bare
// <script type=module> has no bundler to find it, and hardly any browser unpacks zstd by itself.

/** What was packed with zstd (RFC 8878). */
export declare function decompress(packed: Uint8Array<ArrayBuffer>): Uint8Array<ArrayBuffer>;

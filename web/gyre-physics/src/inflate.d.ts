// dist/inflate.js is fflate (MIT), which tools/build_web.sh copies there with its licence: a page with a bare
// <script type=module> has no bundler to find it.

/** What was packed with gzip. */
export declare function gunzipSync(packed: Uint8Array<ArrayBuffer>): Uint8Array<ArrayBuffer>;

// Words kept in an image of four to a texel, word_row texels to a row. On lavapipe a fetch gathers all lanes at once,
// where a load by buffer address is a loop over them.
uvec4 fetch_words(usampler2D words, uint texel) {
  return texelFetch(words, ivec2(texel % word_row, texel / word_row), 0);
}
uint fetch_word(usampler2D words, uint place) {
  const uvec4 t = fetch_words(words, place >> 2u);
  const uint k = place & 3u;
  return k == 0u ? t.x : k == 1u ? t.y : k == 2u ? t.z : t.w;
}

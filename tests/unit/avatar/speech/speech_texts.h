// SPDX-License-Identifier: Apache-2.0
// Texts rich in sounds: pangrams and sentences written to hold every vowel, consonant and
// diphthong.
#pragma once
#include <string>
#include <vector>

namespace wellspring::test {

struct SpeechText {
  std::string lang, text;
};

inline const std::vector<SpeechText>& rich_texts() {
  static const std::vector<SpeechText> texts = {
      {"en",
       "The quick brown fox jumps over the lazy dog. Sphinx of black quartz, judge my vow; "
       "treasure, azure, beige! Which witch thought this through? Air, ear, tour, fire, hour, "
       "boy, cow, go, bird, nurse, north, force, father, bath, loch, button, bottle, rhythm, "
       "singing, church, uh-huh, 1786, 3.5 metres, Mr. Smith's café."},
      {"en-us",
       "Thirty-three thirsty thieves thought they thrilled the throne throughout Thursday. "
       "Water, butter, measure, hot, caught, poor, fur, here, there, lawyer, mirror."},
      {"de",
       "Zwölf Boxkämpfer jagen Viktor quer über den großen Sylter Deich. Falsches Üben von "
       "Xylophonmusik quält jeden größeren Zwerg. Ich, ach, Pfarrer, Mädchen, Häuser, heute, "
       "Genie, Restaurant, Chance, Dschungel, Tschüss, Uhr, Bär, schön, Höhle, 1786."},
      {"sk",
       "Kŕdeľ šťastných ďatľov učí pri ústí Váhu mĺkveho koňa obhrýzať kôru a žrať čerstvé "
       "mäso. Vypätá dcéra grófa Maxwella s IQ nižším ako kôň núti čeľaď hrýzť hŕbu jabĺk. "
       "Džbán, dzekan, hrad, chlieb, ľúbiť, vôňa, päť, banka, stĺp, vŕba, 1786."},
      {"fr",
       "Portez ce vieux whisky au juge blond qui fume. Dès Noël, où un zéphyr haï me vêt de "
       "glaçons würmiens, je dîne d'exquis rôtis de bœuf au kir, à l'aÿ d'âge mûr. Un bon vin "
       "blanc, agneau, oiseau, huit, lui, peu, peur, brun, parking, 1786."},
      {"es",
       "El veloz murciélago hindú comía feliz cardillo y kiwi. La cigüeña tocaba el saxofón "
       "detrás del palenque de paja. Ñandú, guerra, pingüino, lluvia, calle, chico, jamón, "
       "abogado, hielo, ciudad, rey, causa, Europa, 1786."},
      {"pt", "À noite, vovô Kowalsky vê o ímã cair no pé do pinguim. Coração, manhã, rapaz, põe."},
      {"it", "Pranzo d'acqua fa volti sghembi. Gli gnocchi, azione, mezzo, sciare, ghiaccio."},
      {"cs", "Příliš žluťoučký kůň úpěl ďábelské ódy. Řeřicha, mrkev, džbán, vlk."},
      {"pl", "Pchnąć w tę łódź jeża lub ośm skrzyń fig. Szczęście, dźwięk, chrząszcz."},
      {"hu", "Árvíztűrő tükörfúrógép. Nagyon gyönyörű, tyúk, dzsungel, lyuk."},
      {"ru", "Съешь же ещё этих мягких французских булок, да выпей чаю. Жёлтый, щука."},
      {"uk", "Чуєш їх, доцю, га? Кумедна ж ти, прощайся без ґольфів!"},
      {"nl", "Pa's wijze lynx bezag vroom het fikse aquaduct. Geuren, huis, schip, lui."},
      {"sv", "Flygande bäckasiner söka hwila på mjuka tuvor. Sju sjösjuka, kjol, barn."},
  };
  return texts;
}

}  // namespace wellspring::test

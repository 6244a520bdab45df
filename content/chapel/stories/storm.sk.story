<story>
<p><emotion name="joy" weight="0.35"/>Na chvíľu sa zastavte a <gesture name="listen"/>počúvajte. <break time="500ms"/>To je vietor, jediný <emphasis>zbor</emphasis>, ktorý tejto kaplnke ostal.</p>

<p><emotion name="sadness" weight="0.4"/>Pred viac než dvesto rokmi, v jednu novembrovú noc, prišiel ponad kopce <gesture name="large"/>a trhal strechu.
Starý kostolník Ondrej vybehol z dediny, <look at="tomb"/>lebo tu vnútri ležal v hrobe pán hradu <look at="visitor"/><gesture name="point_up"/>a nad ním visela popraskaná klenba.</p>

<p><emotion name="fear" weight="0.6"/>Sotva si zažal lampáš, spadlo <gesture name="count_one"/>prvé rebro. <break time="350ms"/>Potom <gesture name="count_two"/>druhé.
<prosody volume="soft" rate="90%">Schúlil sa pod oblúk apsidy <gesture name="hush" weight="0.7"/>a počítal kamene, ako padali.</prosody></p>

<p><emotion name="surprise" weight="0.5"/>A vedľa neho v tme sedel <emphasis>sokol</emphasis>, mokrý a <gesture name="small"/>rozochvený.
Od múru pod oknom sa nechcel ani <gesture name="shake_head" weight="0.6"/>pohnúť.</p>

<p><emotion name="joy" weight="0.7"/>Ráno tu už nebola strecha. <break time="300ms"/>Ale bolo tu <gesture name="open_arms"/>svetlo, viac svetla, než tu kedy kto videl.
<look at="capital"/>A tamtá hlavica ležala tvárou v omietke a neodlomil sa z nej ani jediný list.<look at="visitor"/></p>

<p><emotion name="neutral"/>Ondrej všetkým vravel, že sokol v múre <gesture name="explain" weight="0.7"/>niečo strážil. Smiali <gesture name="shrug" weight="0.6"/>sa mu.
<prosody rate="90%">Prešlo sedemdesiat rokov, kým sa tam niekto pozrel <emotion name="surprise" weight="0.4"/>a našiel <gesture name="wonder"/><emphasis>korunu</emphasis>.</prosody></p>

<p><emotion name="joy" weight="0.45"/>Ak teda jedného dňa sadne na váš múr vták a <gesture name="emphasize" weight="0.7"/>nebude chcieť odletieť, <break time="300ms"/><prosody rate="88%">neodháňajte ho.</prosody></p>
</story>

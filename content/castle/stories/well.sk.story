<story>
<p><emotion name="joy" weight="0.35"/>Poďte <gesture name="beckon"/>bližšie, lebo tento príbeh sa najlepšie rozpráva potichu.
<look at="well"/>Keď tento hrad stavali, na kopci nebolo ani kvapky <emphasis>vody</emphasis>.<look at="visitor"/></p>

<p><emotion name="sadness" weight="0.5"/>Mladý murár Matej kopal <gesture name="count_three"/>tri letá
a tri letá nachádzal iba suchý kameň.
<prosody rate="90%">Ostatní sa mu smiali,</prosody> <break time="300ms"/>a potom sa smiať prestali,
<gesture name="shake_head" weight="0.6"/>a to bolo horšie.</p>

<p><emotion name="surprise" weight="0.4"/>Raz večer si na okraj šachty sadol <emphasis>sokol</emphasis> a nechcel odletieť.
<emotion name="joy" weight="0.3"/>Matej mal už len pol bochníka chleba, a tak sa oň s vtákom podelil, <gesture name="small"/>omrvinku po omrvinke.
<break time="400ms"/><emotion name="surprise" weight="0.6"/>Ráno sa naňho sokol pozrel, pritisol krídla k telu
a <gesture name="point_near"/>vrhol sa rovno dolu do tmy.</p>

<p><emotion name="neutral"/>Čo by ste <gesture name="shrug" weight="0.5"/>urobili vy?
<emotion name="fear" weight="0.5"/><emphasis>Zliezol</emphasis> za ním, <prosody rate="92%">hlbšie než kedykoľvek predtým</prosody>,
až obloha nad ním nebola <gesture name="small"/>väčšia než minca.
A vtedy to <gesture name="listen"/>začul: <break time="600ms"/><prosody volume="soft" rate="85%">za skalou niečo spievalo.</prosody></p>

<p><emotion name="joy" weight="0.85"/>Jediný <gesture name="emphasize"/><emphasis level="strong">raz</emphasis> sa rozohnal kladivom a prameň vytryskol!
Zdvihol ho ako na dlani, <gesture name="wonder"/>celých sedemdesiat metrov, až na svetlo.</p>

<p><emotion name="joy" weight="0.4"/><point at="well"/>Tam je, a od toho dňa studňa uchováva každý hlas, ktorý do nej zavolá.
<look at="visitor"/>Každú <gesture name="explain" weight="0.7"/>pieseň, každé tajomstvo, <prosody rate="85%">každé meno.</prosody></p>

<p>A tak, ak sa nad ňu v tichý večer nakloníte a <gesture name="hush"/>zatajíte dych, <break time="700ms"/>možno začujete, ako sa Matej smeje.</p>
</story>

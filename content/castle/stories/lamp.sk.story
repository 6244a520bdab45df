<story>
<p><emotion name="joy" weight="0.4"/><look at="visitor"/>Veríte <gesture name="think" weight="0.7"/>vlastným očiam?
<point at="alexandrite"/>Tamto leží kameň a cez deň je zelený ako mach.</p>

<p><look at="visitor"/>Do tejto sály ho <gesture name="explain" weight="0.7"/>priniesol kupec a prisahal, že je to smaragd.
<emotion name="surprise" weight="0.3"/>Hradný pán ho celé dopoludnie držal pri okne a potom zaň zaplatil <gesture name="count_three"/>tromi dobrými poľami.
<emotion name="neutral"/>Večer ho pri stole daroval svojej žene.
<prosody rate="90%"><hold name="torch"/>Zapálili sviece, otvorila dlaň,</prosody> <break time="400ms"/><emotion name="surprise" weight="0.7"/>a kameň bol <emphasis>červený</emphasis>.</p>

<p><emotion name="fear" weight="0.5"/>Volal stráže a volal kňaza.
<prosody volume="soft" rate="90%">Celú noc sedeli okolo neho <gesture name="hush" weight="0.6"/>a celú noc zostal červený ako víno.</prosody>
<hold name="nothing"/><break time="300ms"/><emotion name="joy" weight="0.6"/>Potom týmito oknami vošlo <gesture name="wonder"/>slnko <break time="150ms"/>a kameň tam ležal zelený.</p>

<p><look at="alexandrite"/><emotion name="neutral"/>Nikto ho neoklamal.
<look at="visitor"/>Ten kameň si nechá žltú a fialovú <gesture name="explain"/>a všetko ostatné vráti.
Z denného svetla tak zostane zelená <break time="200ms"/>a zo sviece, ktorá modrú skoro nemá, <gesture name="point_up" weight="0.8"/>zostane červená.</p>

<p><emotion name="joy" weight="0.35"/><point at="second-falcon"/>A obraz pri bráne stráži tajomstvo toho istého druhu.
<look at="visitor"/>Kedysi boli na jeho oblohe <gesture name="count_two"/>dva sokoly a jedného niekto premaľoval.
<prosody volume="soft" rate="92%">Cez deň ho nikto nikdy nenájde.</prosody>
<show piece="second-falcon" layer="candle"/><gesture name="beckon" weight="0.7"/>Pozrite sa naň pri inej lampe.</p>

<p><emotion name="joy" weight="0.5"/>„Ale akú farbu má <emphasis>naozaj</emphasis>?“ pýtajú sa všetky deti.
<look at="alexandrite"/>Hradná pani poznala odpoveď a nosila ten kameň celý život.
<look at="visitor"/><prosody pitch="+6%" rate="88%">„Najprv mi <gesture name="heart"/>povedz,“ hovorila, „v čom svetle.“</prosody></p>
</story>

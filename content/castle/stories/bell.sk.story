<story>
<p><emotion name="joy" weight="0.35"/>Nakloňte sa ku mne bližšie, <gesture name="listen" weight="0.8"/>uši mám už staré; to majú od zvonov.
Mal som <gesture name="think" weight="0.6"/>dvadsaťdeväť rokov, keď si u mňa mesto objednalo <gesture name="large"/><emphasis>najväčší</emphasis> zvon v celom údolí.
Každý dom dal, <gesture name="explain" weight="0.7"/>čo mal z kovu: lyžicu, pracku, zlomený svietnik.
<emotion name="sadness" weight="0.45"/>A jedna stará vdova dala svoj <gesture name="small"/>náprstok, <break time="300ms"/><prosody rate="90%">lebo nič iné nemala.</prosody></p>

<p><emotion name="joy" weight="0.3"/>Zasmial som sa a namiesto do ohňa som si ho strčil do vrecka.
<look at="fireplace"/>Odlievali sme v noci, pri ohni, <gesture name="open_arms"/>ktorý osvetlil celý kopec.<look at="visitor"/>
<emotion name="surprise" weight="0.4"/>Ráno som doň udrel prvý raz, <break time="600ms"/><emotion name="fear" weight="0.45"/><prosody volume="soft" rate="88%">a zvon bol <gesture name="shake_head" weight="0.6"/>nemý.</prosody>
Ani tón, ani cvengnutie; dvadsať centov bronzu <gesture name="shrug" weight="0.6"/>a ticho ako v perine.
<gesture name="count_three"/>Tri razy som ho roztavil <break time="200ms"/>a tri razy <emphasis>mlčal</emphasis>.</p>

<p><emotion name="sadness" weight="0.5"/>Až raz v noci som siahol do vrecka, <break time="350ms"/><prosody rate="88%">a tam bol <gesture name="small"/>náprstok.</prosody>
<gesture name="sigh"/>V živote som sa tak nehanbil.
<emotion name="joy" weight="0.3"/>Šiel som teda za vdovou, <gesture name="bow" weight="0.7"/>poprosil som ju o odpustenie a ona ho sama hodila do žeravého kovu.</p>

<p><emotion name="joy" weight="0.9"/>A zvon <gesture name="wonder"/><emphasis level="strong">zaznel</emphasis>!
<gesture name="point_up"/>Počulo ho sedem dedín a v tej siedmej si vraj <break time="250ms"/>jeden hluchý dal dole klobúk.<gesture name="laugh" weight="0.7"/></p>

<p><emotion name="joy" weight="0.4"/><look at="visitor"/>Z toho, čo zvýšilo, som odlial <gesture name="heart"/>tento malý, čo nosím na retiazke.
Nosím ho, aby som nezabudol: <break time="300ms"/><prosody rate="86%">žiaden dar nie je taký <gesture name="small" weight="0.8"/>malý, aby sa bez neho zvon zaobišiel.</prosody></p>
</story>
